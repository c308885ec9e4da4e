#include "urdf_geometry.h"

#include <filesystem>

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
using soft_tissue::MeshShape;
using soft_tissue::ShapeGeometry;
using soft_tissue::SphereShape;
using soft_tissue::Vec3;
using soft_tissue::VisualConfig;

Vec3 vector(const urdf::Vector3& v)
{
  return {v.x, v.y, v.z};
}

[[noreturn]] void rejectGeometry()
{
  throw soft_tissue::Error("geometry is not a sphere, box, cylinder or mesh");
}

MeshShape cylinderShape(const urdf::Cylinder& cylinder, Scratch& scratch)
{
  MeshShape shape;
  shape.mesh.file = scratch.save("cylinder", cylinderMesh(cylinder.radius, cylinder.length));
  return shape;
}

MeshShape meshShape(const urdf::Mesh& mesh, const std::string& folder, Scratch& scratch)
{
  MeshShape shape;
  shape.mesh.file = resolveResource(mesh.filename, folder);
  if (needsImport(shape.mesh.file))
  {
    const std::string name = std::filesystem::path(shape.mesh.file).filename().string();
    shape.mesh.file = scratch.save(name, importMesh(shape.mesh.file));
  }
  shape.scale = vector(mesh.scale);
  return shape;
}
}  // namespace

std::string Scratch::save(const std::string& made_from, const soft_tissue::TriMesh& mesh)
{
  const std::string file = folder + "/" + std::to_string(number++) + "_" + made_from + ".stl";
  soft_tissue::saveStl(file, mesh);
  return file;
}

ShapeGeometry urdfShape(const urdf::Geometry& geometry, const std::string& folder, Scratch& scratch)
{
  switch (geometry.type)
  {
    case urdf::Geometry::SPHERE:
      return SphereShape{static_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::BOX:
      return BoxShape{vector(static_cast<const urdf::Box&>(geometry).dim)};
    case urdf::Geometry::CYLINDER:
      return cylinderShape(static_cast<const urdf::Cylinder&>(geometry), scratch);
    case urdf::Geometry::MESH:
      return meshShape(static_cast<const urdf::Mesh&>(geometry), folder, scratch);
  }
  rejectGeometry();
}

VisualConfig urdfVisual(const urdf::Visual& visual, const std::string& folder)
{
  VisualConfig look;
  switch (visual.geometry->type)
  {
    case urdf::Geometry::SPHERE:
      look.kind = VisualConfig::Kind::sphere;
      look.size.setConstant(2.0 * static_cast<const urdf::Sphere&>(*visual.geometry).radius);
      break;
    case urdf::Geometry::BOX:
      look.kind = VisualConfig::Kind::box;
      look.size = vector(static_cast<const urdf::Box&>(*visual.geometry).dim);
      break;
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(*visual.geometry);
      look.kind = VisualConfig::Kind::cylinder;
      look.size = Vec3(2.0 * cylinder.radius, 2.0 * cylinder.radius, cylinder.length);
      break;
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(*visual.geometry);
      look.mesh_uri = "file://" + resolveResource(mesh.filename, folder);
      look.size = vector(mesh.scale);
      break;
    }
    default:
      rejectGeometry();
  }
  if (visual.material)
  {
    const urdf::Color& colour = visual.material->color;
    look.colour_rgba = {colour.r, colour.g, colour.b, colour.a};
  }
  return look;
}

}  // namespace soft_tissue_sim
