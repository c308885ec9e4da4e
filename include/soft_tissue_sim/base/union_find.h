#pragma once

#include <numeric>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Disjoint sets of the numbers 0 ... n-1; the smallest member stands for its set. */
class UnionFind
{
 public:
  explicit UnionFind(std::size_t count) : parent_(count)
  {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  Index find(Index i)
  {
    while (parent_[i] != i)
    {
      parent_[i] = parent_[parent_[i]];
      i = parent_[i];
    }
    return i;
  }

  void join(Index a, Index b)
  {
    a = find(a);
    b = find(b);
    parent_[a < b ? b : a] = a < b ? a : b;
  }

  std::size_t sets()
  {
    std::size_t count = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i)
    {
      count += parent_[i] == static_cast<Index>(i) ? 1 : 0;
    }
    return count;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace soft_tissue
