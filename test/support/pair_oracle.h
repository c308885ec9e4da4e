#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue::test
{
/** (second, first) of each pair: in the order in which they are to be found. */
using SortedPairs = std::vector<std::pair<Index, Index>>;

/** Every element of one set against every one of the other. */
inline SortedPairs bruteForcePairs(const ElementSet& first, const ElementSet& second,
                                   const Points& x_first, const Points& x_second, double margin,
                                   bool one_body)
{
  const auto nodesOf = [](const ElementSet& set, Index i) {
    return std::vector<Index>(set.nodes + i * set.nodes_each, set.nodes + (i + 1) * set.nodes_each);
  };
  const auto boxOf = [](const std::vector<Index>& nodes, const Points& x) {
    Box3 box;
    for (const Index node : nodes)
    {
      box.extend(x[node]);
    }
    return box;
  };
  const auto finite = [](const std::vector<Index>& nodes, const Points& x) {
    return std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return x[n].allFinite(); });
  };
  const auto shared = [](const std::vector<Index>& a, const std::vector<Index>& b) {
    return std::any_of(a.begin(), a.end(),
                       [&](Index node) { return std::find(b.begin(), b.end(), node) != b.end(); });
  };
  std::vector<Box3> boxes;
  for (Index i = 0; i < first.count; ++i)
  {
    boxes.push_back(boxOf(nodesOf(first, i), x_first));
    boxes.back().grow(margin);
  }
  SortedPairs pairs;
  for (Index j = 0; j < second.count; ++j)
  {
    const std::vector<Index> b = nodesOf(second, j);
    const Box3 box = boxOf(b, x_second);
    for (Index i = 0; i < first.count; ++i)
    {
      if (boxes[i].overlaps(box) && finite(b, x_second) && finite(nodesOf(first, i), x_first) &&
          !(one_body && shared(nodesOf(first, i), b)))
      {
        pairs.emplace_back(j, i);
      }
    }
  }
  return pairs;
}

inline SortedPairs sortedPairs(const std::vector<ElementPair>& pairs)
{
  SortedPairs result;
  for (const ElementPair& pair : pairs)
  {
    result.emplace_back(pair.second, pair.first);
  }
  return result;
}

}  // namespace soft_tissue::test
