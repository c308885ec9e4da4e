#include "soft_tissue_sim/contact/tool_surface.h"

#include <algorithm>

#include "soft_tissue_sim/mesh/grouping.h"

namespace soft_tissue
{
namespace
{
SurfaceMesh chosenSurface(const RigidBodyShape& tool)
{
  constexpr std::size_t kFewest = 100;
  constexpr std::size_t kMost = 2000;
  constexpr double kFinerBy = 0.8;
  constexpr int kTries = 20;
  constexpr double kThinnest = 1e-3;  // of the whole tool
  const Box3 bounds = tool.bounds();
  double max_edge =
      std::max(0.5 * tool.innerRadius(), kThinnest * (bounds.max - bounds.min).norm());
  SurfaceMesh surface = tool.surface(max_edge);
  const bool too_many = surface.nodes.size() > kMost;
  for (int i = 0; i < kTries; ++i)
  {
    const std::size_t count = surface.nodes.size();
    if (too_many ? count <= kMost : count >= kFewest)
    {
      break;
    }
    max_edge *= too_many ? 1.0 / kFinerBy : kFinerBy;
    surface = tool.surface(max_edge);
  }
  return surface;
}

std::vector<bool> hiddenNodes(const RigidBodyShape& tool, const Points& nodes)
{
  const double depth = 1e-6 * tool.innerRadius();
  std::vector<bool> hidden;
  for (const Vec3& node : nodes)
  {
    hidden.push_back(tool.distance(node).distance < -depth);
  }
  return hidden;
}
}  // namespace

ToolSurface sampleToolSurface(const RigidBodyShape& tool)
{
  const SurfaceMesh mesh = chosenSurface(tool);
  const std::vector<bool> hidden = hiddenNodes(tool, mesh.nodes);
  std::vector<double> third;
  std::vector<double> node_area(mesh.nodes.size(), 0.0);
  std::vector<Edge> keys;
  for (const Triangle& t : mesh.triangles)
  {
    const Vec3& a = mesh.nodes[t[0]];
    third.push_back((mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).norm() / 6.0);
    for (int k = 0; k < 3; ++k)
    {
      node_area[t[k]] += third.back();
      keys.push_back(sortedKey(Edge{t[k], t[(k + 1) % 3]}));
    }
  }
  ToolSurface surface;
  std::vector<Index> place(mesh.nodes.size(), -1);
  const auto keep = [&](Index node) {
    if (place[node] < 0)
    {
      place[node] = static_cast<Index>(surface.nodes.size());
      surface.nodes.push_back(mesh.nodes[node]);
      surface.node_area.push_back(hidden[node] ? 0.0 : node_area[node]);
    }
    return place[node];
  };
  const Adjacency groups = groupEqual(static_cast<Index>(mesh.nodes.size()), keys);
  for (Index row = 0; row < groups.size(); ++row)
  {
    const Edge edge = keys[*groups.begin(row)];
    if (hidden[edge[0]] && hidden[edge[1]])
    {
      continue;
    }
    double area = 0.0;
    for (const Index* corner = groups.begin(row); corner != groups.end(row); ++corner)
    {
      area += third[*corner / 3];
    }
    surface.edges.push_back({keep(edge[0]), keep(edge[1])});
    surface.edge_area.push_back(area);
  }
  return surface;
}

}  // namespace soft_tissue
