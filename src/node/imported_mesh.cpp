#include "soft_tissue_sim/node/imported_mesh.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>
#include <string_view>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Index;
using soft_tissue::TriMesh;
using soft_tissue::Vec3;

constexpr std::array<std::string_view, 4> kReadByTheCore{".stl", ".obj", ".ply", ".vtk"};

void addMesh(const aiMesh& part, const aiMatrix4x4& X_WP, TriMesh& mesh)
{
  const bool mirrored = aiMatrix3x3(X_WP).Determinant() < 0.0f;
  for (unsigned int face = 0; face < part.mNumFaces; ++face)
  {
    const aiFace& corners = part.mFaces[face];
    const Index first = static_cast<Index>(mesh.nodes.size());
    for (unsigned int corner = 0; corner < 3; ++corner)
    {
      const aiVector3D p = X_WP * part.mVertices[corners.mIndices[corner]];
      mesh.nodes.emplace_back(p.x, p.y, p.z);
    }
    mesh.triangles.push_back({first, first + (mirrored ? 2 : 1), first + (mirrored ? 1 : 2)});
  }
}

void addNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& X_WParent, TriMesh& mesh)
{
  const aiMatrix4x4 X_WN = X_WParent * node.mTransformation;
  for (unsigned int i = 0; i < node.mNumMeshes; ++i)
  {
    addMesh(*scene.mMeshes[node.mMeshes[i]], X_WN, mesh);
  }
  for (unsigned int i = 0; i < node.mNumChildren; ++i)
  {
    addNode(scene, *node.mChildren[i], X_WN, mesh);
  }
}

}  // namespace

bool needsImport(const std::string& file)
{
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kReadByTheCore.begin(), kReadByTheCore.end(), ending) == kReadByTheCore.end();
}

TriMesh importMesh(const std::string& file)
{
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file, aiProcess_Triangulate | aiProcess_SortByPType);
  if (scene == nullptr)
  {
    throw soft_tissue::Error(file + ": can't be read: " + importer.GetErrorString());
  }
  TriMesh mesh;
  addNode(*scene, *scene->mRootNode, aiMatrix4x4(), mesh);
  if (mesh.triangles.empty())
  {
    throw soft_tissue::Error(file + ": holds no triangles");
  }
  return mesh;
}

}  // namespace soft_tissue_sim
