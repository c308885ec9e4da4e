#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** Rows of the elements that contain each node. */
template <std::size_t K>
Adjacency incidence(Index node_count, const std::vector<std::array<Index, K>>& elements)
{
  Adjacency rows;
  rows.offsets.assign(static_cast<std::size_t>(node_count) + 1, 0);
  for (const auto& element : elements)
  {
    for (const Index node : element)
    {
      ++rows.offsets[node + 1];
    }
  }
  for (Index i = 0; i < node_count; ++i)
  {
    rows.offsets[i + 1] += rows.offsets[i];
  }
  rows.items.resize(rows.offsets.back());
  std::vector<Index> fill(rows.offsets.begin(), rows.offsets.end() - 1);
  for (std::size_t e = 0; e < elements.size(); ++e)
  {
    for (const Index node : elements[e])
    {
      rows.items[fill[node]++] = static_cast<Index>(e);
    }
  }
  return rows;
}

/** Nodes that share one of the elements with each node. */
template <std::size_t K>
Adjacency elementNeighbours(Index node_count, const std::vector<std::array<Index, K>>& elements)
{
  const Adjacency incident = incidence(node_count, elements);
  Adjacency rows;
  rows.offsets.reserve(static_cast<std::size_t>(node_count) + 1);
  rows.offsets.push_back(0);
  std::vector<Index> row;
  for (Index node = 0; node < node_count; ++node)
  {
    row.clear();
    for (const Index* element = incident.begin(node); element != incident.end(node); ++element)
    {
      row.insert(row.end(), elements[*element].begin(), elements[*element].end());
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    std::remove_copy(row.begin(), row.end(), std::back_inserter(rows.items), node);
    rows.offsets.push_back(static_cast<Index>(rows.items.size()));
  }
  return rows;
}

}  // namespace soft_tissue
