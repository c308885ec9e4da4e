#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/block_matrix.h"
#include "soft_tissue_sim/solver/pcg_kernels.h"

namespace soft_tissue
{
/** The couplings of a matrix by rows, with their transposes, in one precision, and with nodes in
 * another order. */
template <typename Real>
class CouplingRows
{
 public:
  /** @param place  of each node in that order */
  void load(const std::vector<Coupling>& couplings, const std::vector<Index>& place)
  {
    entries_.clear();
    for (Index i = 0; i < static_cast<Index>(couplings.size()); ++i)
    {
      const Index row = place[couplings[i].row], column = place[couplings[i].column];
      entries_.push_back({row, column, i, false});
      entries_.push_back({column, row, i, true});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.row != b.row ? a.row < b.row : a.column < b.column;
    });
    rows_.clear();
    offsets_.clear();
    columns_.clear();
    values_.resize(9 * entries_.size() + 1);
    for (std::size_t k = 0; k < entries_.size(); ++k)
    {
      const Entry& entry = entries_[k];
      if (rows_.empty() || rows_.back() != entry.row)
      {
        rows_.push_back(entry.row);
        offsets_.push_back(static_cast<Index>(k));
      }
      columns_.push_back(entry.column);
      const double* block = couplings[entry.coupling].block.data();
      for (int i = 0; i < 9; ++i)
      {
        values_[9 * k + i] = static_cast<Real>(block[entry.transposed ? 3 * (i % 3) + i / 3 : i]);
      }
    }
    offsets_.push_back(static_cast<Index>(entries_.size()));
    product_.resize(3 * rows_.size());
  }

  /** q += C p for flat vectors, 3 numbers a node. @return p . C p */
  double addProduct(const PcgKernels<Real>& kernels, const Real* p, Real* q)
  {
    constexpr Index kGrain = 128;
    const BlockRows<Real> rows = {offsets_.data(), columns_.data(), values_.data()};
    return parallelSum(static_cast<Index>(rows_.size()), kGrain, [&](Index begin, Index end) {
      kernels.multiplyRows(rows, begin, end, p, product_.data());
      double sum = 0.0;
      for (Index i = begin; i < end; ++i)
      {
        const Real* from = product_.data() + 3 * static_cast<std::size_t>(i);
        for (int k = 0; k < 3; ++k)
        {
          q[3 * rows_[i] + k] += from[k];
          sum += static_cast<double>(p[3 * rows_[i] + k]) * from[k];
        }
      }
      return sum;
    });
  }

 private:
  struct Entry
  {
    Index row, column, coupling;
    bool transposed;
  };
  std::vector<Entry> entries_;  ///< by row, then column
  std::vector<Index> rows_;     ///< that have any
  std::vector<Index> offsets_;  ///< of those rows
  std::vector<Index> columns_;
  std::vector<Real> values_;
  std::vector<Real> product_;
};

}  // namespace soft_tissue
