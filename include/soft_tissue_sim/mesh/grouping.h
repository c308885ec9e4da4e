#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** The node tuple in ascending order, so that equal faces or edges compare equal. */
template <std::size_t K>
std::array<Index, K> sortedKey(std::array<Index, K> nodes)
{
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

/**
 * Groups equal keys: one row per distinct key, ascending, holding the places of that key in `keys`.
 *
 * Counting sort over the first entry, then a small sort in each bucket: close to linear for meshes.
 * @param keys  node tuples, each ascending, entries in [0, node_count)
 */
template <std::size_t K>
Adjacency groupEqual(Index node_count, const std::vector<std::array<Index, K>>& keys)
{
  std::vector<Index> start(static_cast<std::size_t>(node_count) + 1, 0);
  for (const auto& key : keys)
  {
    ++start[key[0] + 1];
  }
  for (Index i = 0; i < node_count; ++i)
  {
    start[i + 1] += start[i];
  }
  std::vector<Index> order(keys.size());
  std::vector<Index> fill(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < keys.size(); ++i)
  {
    order[fill[keys[i][0]]++] = static_cast<Index>(i);
  }
  Adjacency groups;
  groups.offsets.push_back(0);
  for (Index bucket = 0; bucket < node_count; ++bucket)
  {
    std::sort(order.begin() + start[bucket], order.begin() + start[bucket + 1],
              [&](Index a, Index b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
    for (Index i = start[bucket]; i < start[bucket + 1]; ++i)
    {
      if (i + 1 == start[bucket + 1] || keys[order[i]] != keys[order[i + 1]])
      {
        groups.offsets.push_back(i + 1);
      }
    }
  }
  groups.items = std::move(order);
  return groups;
}

/** Tet faces grouped by their nodes: items are 4 * tet + k for the face opposite to the tet's node
 * k. */
Adjacency groupTetFaces(Index node_count, const std::vector<Tet>& tets);

/** Triangle edges grouped by their nodes: items are 3 * triangle + k for edge (v_k, v_(k+1)). */
Adjacency groupTriangleEdges(Index node_count, const std::vector<Triangle>& triangles);

/** Face k of a right-handed tet, opposite to its node k, counter-clockwise seen from outside. */
inline Triangle tetFace(const Tet& tet, Index k)
{
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  return {tet[kFaces[k][0]], tet[kFaces[k][1]], tet[kFaces[k][2]]};
}

}  // namespace soft_tissue
