#include "field_checks.h"

#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
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

void checkPositions(const Points& x, std::size_t node_count)
{
  if (x.size() != node_count)
  {
    throw Error("distance field: " + std::to_string(x.size()) + " positions for " +
                std::to_string(node_count) + " nodes");
  }
}

void checkWanted(const std::vector<Index>& wanted, std::size_t node_count)
{
  for (const Index node : wanted)
  {
    if (node < 0 || node >= static_cast<Index>(node_count))
    {
      throw Error("distance field: wanted node " + std::to_string(node) + ", must be in [0, " +
                  std::to_string(node_count) + ")");
    }
  }
}

}  // namespace soft_tissue
