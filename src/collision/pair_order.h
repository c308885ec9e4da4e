#pragma once

#include <cstdint>
#include <vector>

#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
/** Puts pairs in order in a time that grows with their number, not with that of the elements. */
class PairOrder
{
 public:
  explicit PairOrder(Index second_count);

  /** Ascending by second, then by first. */
  void arrange(const ElementPair* found, std::size_t count, std::vector<ElementPair>& pairs);

 private:
  std::vector<Index> places_;         ///< per second element; all 0 between two calls
  std::vector<std::uint64_t> named_;  ///< a bit for each second element; all 0 between two calls
};

}  // namespace soft_tissue
