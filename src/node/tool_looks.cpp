#include "soft_tissue_sim/node/tool_looks.h"

#include <algorithm>

#include "marker_shapes.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Vec3;
using soft_tissue::VisualConfig;
using visualization_msgs::Marker;

constexpr double kOpacity = 0.35;  // the arrows of its contacts show through

Marker surfaceMarker(const std::string& ns, const soft_tissue::TriMesh& surface)
{
  Marker marker = makeMarker(ns, Marker::TRIANGLE_LIST);
  const std::vector<Vec3> normals = nodeNormals(surface.nodes, surface.triangles);
  for (const soft_tissue::Triangle& triangle : surface.triangles)
  {
    for (const soft_tissue::Index node : triangle)
    {
      addCorner(marker, surface.nodes[node], lit(rgb(0.75, 0.78, 0.82, kOpacity), normals[node]));
    }
  }
  return marker;
}

int typeOf(VisualConfig::Kind kind)
{
  switch (kind)
  {
    case VisualConfig::Kind::sphere:
      return Marker::SPHERE;
    case VisualConfig::Kind::box:
      return Marker::CUBE;
    case VisualConfig::Kind::cylinder:
      return Marker::CYLINDER;
    case VisualConfig::Kind::mesh:
      return Marker::MESH_RESOURCE;
  }
  return Marker::CUBE;
}

Marker visualMarker(const std::string& ns, const VisualConfig& visual)
{
  Marker marker = makeMarker(ns, typeOf(visual.kind));
  marker.scale.x = visual.size.x();
  marker.scale.y = visual.size.y();
  marker.scale.z = visual.size.z();
  marker.mesh_resource = visual.mesh_uri;
  const std::array<double, 4> colour =
      visual.colour_rgba.value_or(std::array{0.75, 0.78, 0.82, 1.0});
  marker.color = rgb(colour[0], colour[1], colour[2], kOpacity * colour[3]);
  return marker;
}
}  // namespace

std::vector<ToolLook> toolLooks(const soft_tissue::ToolInfo& tool,
                                const soft_tissue::ToolConfig& config)
{
  std::vector<ToolLook> looks;
  for (const VisualConfig& visual : config.visuals)
  {
    looks.push_back({visualMarker(tool.name, visual), visual.link, visual.origin.toPose()});
  }
  for (const soft_tissue::ToolPartInfo& part : tool.parts)
  {
    const bool has_visual =
        std::any_of(config.visuals.begin(), config.visuals.end(), [&](const VisualConfig& visual) {
          return config.linkage.carrier(visual.link) == part.link;
        });
    if (!has_visual)
    {
      looks.push_back(
          {surfaceMarker(tool.name, part.surface), part.link, soft_tissue::Pose::Identity()});
    }
  }
  for (std::size_t i = 0; i < looks.size(); ++i)
  {
    looks[i].marker.id = static_cast<int>(i);
  }
  return looks;
}

}  // namespace soft_tissue_sim
