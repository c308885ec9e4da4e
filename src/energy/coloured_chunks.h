#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/index.h"

namespace soft_tissue
{
/**
 * The smallest colour for each chunk of `size` elements that no chunk before it with a common node
 * has.
 * @param elements  their nodes; negative ones are none
 */
template <typename Elements>
std::vector<int> colourChunks(std::size_t node_count, const Elements& elements,
                              const std::vector<Index>& order, std::size_t size)
{
  std::vector<std::vector<int>> taken(node_count);
  std::vector<int> colours;
  for (std::size_t first = 0; first < order.size(); first += size)
  {
    const std::size_t last = std::min(first + size, order.size());
    std::vector<int> near;
    for (std::size_t k = first; k < last; ++k)
    {
      for (const Index node : elements[order[k]])
      {
        if (node >= 0)
        {
          near.insert(near.end(), taken[node].begin(), taken[node].end());
        }
      }
    }
    int colour = 0;
    while (std::find(near.begin(), near.end(), colour) != near.end())
    {
      ++colour;
    }
    for (std::size_t k = first; k < last; ++k)
    {
      for (const Index node : elements[order[k]])
      {
        if (node >= 0 &&
            std::find(taken[node].begin(), taken[node].end(), colour) == taken[node].end())
        {
          taken[node].push_back(colour);
        }
      }
    }
    colours.push_back(colour);
  }
  return colours;
}

}  // namespace soft_tissue
