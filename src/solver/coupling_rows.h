#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/** The couplings of a matrix by rows, with their transposes, in one precision. */
template <typename Real>
class CouplingRows
{
 public:
  void load(const std::vector<Coupling>& couplings)
  {
    entries_.clear();
    for (const Coupling& c : couplings)
    {
      entries_.push_back({c.row, c.column, c.block.template cast<Real>()});
      entries_.push_back({c.column, c.row, c.block.transpose().template cast<Real>()});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.row != b.row ? a.row < b.row : a.column < b.column;
    });
    rows_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i)
    {
      if (i == 0 || entries_[i].row != entries_[i - 1].row)
      {
        rows_.push_back(static_cast<Index>(i));
      }
    }
    rows_.push_back(static_cast<Index>(entries_.size()));
  }

  /** q += C p for flat vectors, 3 numbers a node. @return p . C p */
  double addProduct(const Real* p, Real* q) const
  {
    constexpr Index kGrain = 64;
    return parallelSum(static_cast<Index>(rows_.size()) - 1, kGrain, [&](Index begin, Index end) {
      double product = 0.0;
      for (Index i = begin; i < end; ++i)
      {
        Vector sum = Vector::Zero();
        for (Index k = rows_[i]; k < rows_[i + 1]; ++k)
        {
          sum += entries_[k].block * Eigen::Map<const Vector>(p + 3 * entries_[k].column);
        }
        const Index row = entries_[rows_[i]].row;
        Eigen::Map<Vector>(q + 3 * row) += sum;
        product += static_cast<double>(Eigen::Map<const Vector>(p + 3 * row).dot(sum));
      }
      return product;
    });
  }

 private:
  using Vector = Eigen::Matrix<Real, 3, 1>;
  struct Entry
  {
    Index row, column;
    Eigen::Matrix<Real, 3, 3> block;
  };
  std::vector<Entry> entries_;  ///< by row, then column
  std::vector<Index> rows_;     ///< where rows begin, and the end
};

}  // namespace soft_tissue
