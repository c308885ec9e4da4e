#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** The nodes of each tet by number: F is that of any order, and blocks are then above the diagonal.
 */
inline std::vector<Index> ascendingNodes(const std::vector<Tet>& tets)
{
  std::vector<Index> nodes;
  nodes.reserve(4 * tets.size());
  for (Tet tet : tets)
  {
    std::sort(tet.begin(), tet.end());
    nodes.insert(nodes.end(), tet.begin(), tet.end());
  }
  return nodes;
}

}  // namespace soft_tissue
