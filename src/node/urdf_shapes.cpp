#include "soft_tissue_sim/node/urdf_shapes.h"

#include <urdf_parser/urdf_parser.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/node/cylinder_mesh.h"
#include "soft_tissue_sim/node/imported_mesh.h"
#include "soft_tissue_sim/node/resource_path.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::BoxShape;
using soft_tissue::Error;
using soft_tissue::MeshShape;
using soft_tissue::PoseConfig;
using soft_tissue::ShapeGeometry;
using soft_tissue::SphereShape;
using soft_tissue::UrdfShapeConfig;
using soft_tissue::Vec3;

urdf::ModelInterfaceSharedPtr readModel(const std::string& file)
{
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream)
  {
    throw Error("urdf " + file + ": can't be read");
  }
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text.str());
  if (!model)
  {
    throw Error("urdf " + file + ": is not a valid robot description");
  }
  return model;
}

std::string linksWithCollision(const urdf::ModelInterface& model)
{
  std::string names;
  for (const auto& [name, link] : model.links_)
  {
    if (!link->collision_array.empty())
    {
      names += (names.empty() ? "" : ", ") + name;
    }
  }
  return names.empty() ? "none has" : "those that have: " + names;
}

PoseConfig poseConfig(const urdf::Pose& pose)
{
  PoseConfig config;
  config.position_m = Vec3(pose.position.x, pose.position.y, pose.position.z);
  Vec3& rpy = config.rotation_rpy_rad;
  pose.rotation.getRPY(rpy.x(), rpy.y(), rpy.z());
  return config;
}

/** Where a shape made here is written: a name of its own that still tells what it was made from. */
struct Scratch
{
  std::string folder;
  std::size_t number;

  std::string save(const std::string& made_from, const soft_tissue::TriMesh& mesh) const
  {
    const std::string file = folder + "/" + std::to_string(number) + "_" + made_from + ".stl";
    soft_tissue::saveStl(file, mesh);
    return file;
  }
};

MeshShape cylinderShape(const urdf::Cylinder& cylinder, const Scratch& scratch)
{
  MeshShape shape;
  shape.mesh.file = scratch.save("cylinder", cylinderMesh(cylinder.radius, cylinder.length));
  return shape;
}

MeshShape meshShape(const urdf::Mesh& mesh, const std::string& folder, const Scratch& scratch)
{
  MeshShape shape;
  shape.mesh.file = resolveResource(mesh.filename, folder);
  if (needsImport(shape.mesh.file))
  {
    const std::string name = std::filesystem::path(shape.mesh.file).filename().string();
    shape.mesh.file = scratch.save(name, importMesh(shape.mesh.file));
  }
  shape.scale = Vec3(mesh.scale.x, mesh.scale.y, mesh.scale.z);
  return shape;
}

ShapeGeometry shapeGeometry(const urdf::Geometry& geometry, const std::string& folder,
                            const Scratch& scratch)
{
  switch (geometry.type)
  {
    case urdf::Geometry::SPHERE:
      return SphereShape{static_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      return BoxShape{Vec3(size.x, size.y, size.z)};
    }
    case urdf::Geometry::CYLINDER:
      return cylinderShape(static_cast<const urdf::Cylinder&>(geometry), scratch);
    case urdf::Geometry::MESH:
      return meshShape(static_cast<const urdf::Mesh&>(geometry), folder, scratch);
  }
  throw Error("geometry is not a sphere, box, cylinder or mesh");
}

}  // namespace

std::vector<soft_tissue::ShapeConfig> shapesFromUrdf(const UrdfShapeConfig& urdf,
                                                     const std::string& scratch)
{
  const urdf::ModelInterfaceSharedPtr model = readModel(urdf.file);
  const urdf::LinkConstSharedPtr link = model->getLink(urdf.link);
  const std::string where = "urdf " + urdf.file + ": link '" + urdf.link + "'";
  if (!link)
  {
    throw Error(where + " does not exist");
  }
  if (link->collision_array.empty())
  {
    throw Error(where + " has no collision geometry; " + linksWithCollision(*model));
  }
  const std::string folder = std::filesystem::absolute(urdf.file).parent_path().string();
  std::vector<soft_tissue::ShapeConfig> shapes;
  for (const urdf::CollisionSharedPtr& collision : link->collision_array)
  {
    if (!collision || !collision->geometry)
    {
      throw Error(where + " has a collision element without geometry");
    }
    try
    {
      shapes.push_back({shapeGeometry(*collision->geometry, folder, {scratch, shapes.size()}),
                        poseConfig(collision->origin)});
    }
    catch (const Error& error)
    {
      throw Error(where + ": " + error.what());
    }
  }
  return shapes;
}

}  // namespace soft_tissue_sim
