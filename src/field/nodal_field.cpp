#include "nodal_field.h"

#include <limits>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr double kNotMarched = std::numeric_limits<double>::quiet_NaN();

const FieldTopology& checked(const FieldTopology& topology)
{
  if (!topology.surface || !topology.node_neighbours)
  {
    throw Error("distance field: surface and node_neighbours must both be given");
  }
  const std::size_t node_count = topology.node_neighbours->size();
  if (topology.surface->node_slot.size() != node_count)
  {
    throw Error("distance field: the surface is of a mesh of " +
                std::to_string(topology.surface->node_slot.size()) +
                " nodes, node_neighbours of one of " + std::to_string(node_count));
  }
  return topology;
}
}  // namespace

NodalField::NodalField(const FieldTopology& topology) : topology_(checked(topology))
{
  const std::size_t node_count = topology_.node_neighbours->size();
  depth_.assign(node_count, kNotMarched);
  closest_.assign(node_count, -1);
  touched_.reserve(node_count);
  for (const Index node : topology_.surface->nodes)
  {
    depth_[node] = 0.0;
    closest_[node] = *topology_.surface->node_triangles.begin(node);
  }
}

void NodalField::forgetMarch(const Points& x)
{
  if (x.size() != nodeCount())
  {
    throw Error("distance field: " + std::to_string(x.size()) + " positions for " +
                std::to_string(nodeCount()) + " nodes");
  }
  for (const Index node : touched_)
  {
    depth_[node] = kNotMarched;
    closest_[node] = -1;
  }
  touched_.clear();
}

void NodalField::exchange(StateArchive& archive)
{
  archive.values(depth_);
  archive.values(closest_);
  archive.list(touched_);
  archive.value(evaluations_);
}

Points NodalField::finiteOf(Points x)
{
  for (Vec3& p : x)
  {
    p = p.allFinite() ? p : Vec3(Vec3::Zero());
  }
  return x;
}

void NodalField::checkWanted(const std::vector<Index>& wanted) const
{
  for (const Index node : wanted)
  {
    if (node < 0 || node >= static_cast<Index>(nodeCount()))
    {
      throw Error("distance field: wanted node " + std::to_string(node) + ", must be in [0, " +
                  std::to_string(nodeCount()) + ")");
    }
  }
}

}  // namespace soft_tissue
