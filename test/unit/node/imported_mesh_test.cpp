#include "soft_tissue_sim/node/imported_mesh.h"

#include <gtest/gtest.h>

#include <fstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/node/scratch_folder.h"
#include "support/collada.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::TriMesh;
using soft_tissue::Vec3;

class ImportedMesh : public testing::Test
{
 protected:
  std::string write(const std::string& name, const std::string& text) const
  {
    const std::string file = folder_.path() + "/" + name;
    std::ofstream(file) << text;
    return file;
  }

  TriMesh import(const std::string& collada) const { return importMesh(write("a.dae", collada)); }

  std::string complaint(const std::string& name, const std::string& text) const
  {
    try
    {
      importMesh(write(name, text));
      return "";
    }
    catch (const soft_tissue::Error& error)
    {
      return error.what();
    }
  }

  ScratchFolder folder_;
};

double volume(const TriMesh& mesh)
{
  double volume = 0.0;
  for (const soft_tissue::Triangle& t : mesh.triangles)
  {
    volume += mesh.nodes[t[0]].dot(mesh.nodes[t[1]].cross(mesh.nodes[t[2]])) / 6.0;
  }
  return volume;
}

Vec3 highest(const TriMesh& mesh)
{
  Vec3 highest = mesh.nodes.at(0);
  for (const Vec3& p : mesh.nodes)
  {
    highest = highest.cwiseMax(p);
  }
  return highest;
}

TEST_F(ImportedMesh, colladaIsReadAsWritten)
{
  const TriMesh mesh = import(colladaTet());
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(volume(mesh), 1.0, 1e-6);  // edges 1, 2, 3 along the axes
  EXPECT_TRUE(highest(mesh).isApprox(Vec3(1.0, 2.0, 3.0), 1e-6));
}

TEST_F(ImportedMesh, unitAndNodesCountAndTheUpAxisDoesNot)
{
  const TriMesh mesh = import(colladaTet(0.001, "Y_UP", "<translate>10 20 30</translate>"));
  EXPECT_TRUE(highest(mesh).isApprox(Vec3(0.011, 0.022, 0.033), 1e-6)) << highest(mesh).transpose();
  EXPECT_NEAR(volume(mesh), 1.0e-9, 1e-14);
}

TEST_F(ImportedMesh, mirroredNodesKeepTheirOutsideOut)
{
  EXPECT_NEAR(volume(import(colladaTet(1.0, "Z_UP", "<scale>-1 1 1</scale>"))), 1.0, 1e-6);
}

TEST_F(ImportedMesh, noTriangleIsLost)
{
  // A strip of slivers and a fan of coinciding corners: none of them is anybody's to drop.
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nv 0.5 0 0\nf 1 2 3\nf 1 2 4\nf 1 5 2\nf 3 4 1\n";
  EXPECT_EQ(importMesh(write("a.obj", obj)).triangles.size(), 4u);
}

TEST_F(ImportedMesh, whatCantBeReadIsNamedWithTheReason)
{
  const std::string broken = complaint("broken.dae", "<COLLADA");
  EXPECT_NE(broken.find("broken.dae: can't be read: "), std::string::npos) << broken;
  EXPECT_GT(broken.size(), broken.find("can't be read: ") + 20) << broken;
  const std::string unknown = complaint("a.unknown", "?");
  EXPECT_NE(unknown.find("a.unknown: can't be read: "), std::string::npos) << unknown;
  const std::string line = complaint("line.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  EXPECT_NE(line.find("line.obj"), std::string::npos) << line;
}

TEST(NeedsImport, onlyWhatTheCoreCantRead)
{
  for (const char* file : {"a.stl", "/b/a.STL", "a.obj", "a.ply", "a.vtk"})
  {
    EXPECT_FALSE(needsImport(file)) << file;
  }
  for (const char* file : {"a.dae", "a.DAE", "a.glb", "stl", ""})
  {
    EXPECT_TRUE(needsImport(file)) << file;
  }
}

}  // namespace
}  // namespace soft_tissue_sim
