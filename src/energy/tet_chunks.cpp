#include "soft_tissue_sim/energy/tet_chunks.h"

#include <algorithm>

#include "coloured_chunks.h"
#include "soft_tissue_sim/energy/tet_kernels.h"
#include "soft_tissue_sim/geometry/morton_order.h"

namespace soft_tissue
{
namespace
{
/** Chunks a body is cut into at most, and the groups of lanes a chunk may hold. */
constexpr Index kChunks = 96;
constexpr Index kFewestGroups = 4;
constexpr Index kMostGroups = 64;

/** Tets along a Morton curve through their centres. */
std::vector<Index> nearbyOrder(const TetMesh& mesh)
{
  Points centres;
  centres.reserve(mesh.tets.size());
  for (const Tet& tet : mesh.tets)
  {
    Vec3 centre = Vec3::Zero();
    for (const Index node : tet)
    {
      centre += 0.25 * mesh.nodes[node];
    }
    centres.push_back(centre);
  }
  return mortonOrder(centres);
}
}  // namespace

TetChunks chunkTets(const TetMesh& mesh)
{
  const std::vector<Index> order = nearbyOrder(mesh);
  const Index group_count = (static_cast<Index>(order.size()) + kTetLanes - 1) / kTetLanes;
  const Index groups_each = std::clamp(group_count / kChunks, kFewestGroups, kMostGroups);
  const std::size_t size = static_cast<std::size_t>(groups_each) * kTetLanes;
  const std::vector<int> colours = colourChunks(mesh.nodes.size(), mesh.tets, order, size);
  TetChunks chunks;
  chunks.groups.push_back(0);
  chunks.colours.push_back(0);
  const int colour_count =
      colours.empty() ? 0 : 1 + *std::max_element(colours.begin(), colours.end());
  for (int colour = 0; colour < colour_count; ++colour)
  {
    for (std::size_t chunk = 0; chunk < colours.size(); ++chunk)
    {
      if (colours[chunk] != colour)
      {
        continue;
      }
      const auto first = order.begin() + chunk * size;
      const std::size_t last = std::min((chunk + 1) * size, order.size());
      chunks.tets.insert(chunks.tets.end(), first, order.begin() + last);
      chunks.tets.resize((chunks.tets.size() + kTetLanes - 1) / kTetLanes * kTetLanes, -1);
      chunks.groups.push_back(static_cast<Index>(chunks.tets.size()) / kTetLanes);
    }
    chunks.colours.push_back(static_cast<Index>(chunks.groups.size()) - 1);
  }
  return chunks;
}

}  // namespace soft_tissue
