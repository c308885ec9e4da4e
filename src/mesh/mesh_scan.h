#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "soft_tissue_sim/mesh/grouping.h"

namespace soft_tissue
{
// What check and repair both look for.

/** Per node, the first node with equal coordinates (itself if it is the first). */
std::vector<Index> firstAtSamePlace(const Points& nodes);

/** Per element, the first one with the same set of nodes (itself if it is the first). */
template <std::size_t K>
std::vector<Index> firstWithSameNodes(Index node_count,
                                      const std::vector<std::array<Index, K>>& elements)
{
  std::vector<std::array<Index, K>> keys;
  keys.reserve(elements.size());
  for (const auto& element : elements)
  {
    keys.push_back(sortedKey(element));
  }
  const Adjacency groups = groupEqual(node_count, keys);
  std::vector<Index> first(elements.size());
  for (Index row = 0; row < groups.size(); ++row)
  {
    for (const Index* item = groups.begin(row); item != groups.end(row); ++item)
    {
      first[*item] = *groups.begin(row);
    }
  }
  return first;
}

/** Entries that are not their own first. */
std::size_t countRepeated(const std::vector<Index>& first);

/** Per node, 1 if an element names it. */
template <std::size_t K>
std::vector<char> usedNodes(std::size_t node_count,
                            const std::vector<std::array<Index, K>>& elements)
{
  std::vector<char> used(node_count, 0);
  for (const auto& element : elements)
  {
    for (const Index node : element)
    {
      used[node] = 1;
    }
  }
  return used;
}

/** True if the triangle's area is zero to rounding, or two of its nodes are one. */
bool hasZeroArea(const Points& nodes, const Triangle& triangle);

/** True if the tet's volume is zero to rounding. */
bool hasZeroVolume(const Points& nodes, const Tet& tet);

/** Edges of the axis-aligned box around the nodes. */
Vec3 boxSize(const Points& nodes);

}  // namespace soft_tissue
