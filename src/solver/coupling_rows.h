#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/block_matrix.h"
#include "soft_tissue_sim/solver/packed_rows.h"

namespace soft_tissue
{
/** The couplings of a matrix by rows, with their transposes, in one precision, and with nodes in
 * another order. */
template <typename Real>
class CouplingRows
{
 public:
  /** @param place  of each node in that order */
  void load(const PcgKernels<Real>& kernels, const std::vector<Coupling>& couplings,
            const std::vector<Index>& place)
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
    blocks_.resize(9 * couplings.size() + 1);
    for (std::size_t i = 0; i < couplings.size(); ++i)
    {
      std::copy_n(couplings[i].block.data(), 9, blocks_.data() + 9 * i);
    }
    nodes_.clear();
    rows_.clear();
    for (const Entry& entry : entries_)
    {
      if (nodes_.empty() || nodes_.back() != entry.row)
      {
        if (!nodes_.empty())
        {
          rows_.endRow();
        }
        nodes_.push_back(entry.row);
      }
      rows_.add(entry.column, entry.coupling, entry.transposed);
    }
    if (!nodes_.empty())
    {
      rows_.endRow();
    }
    rows_.finish();
    rows_.load(kernels, blocks_.data(), 0, rows_.rows());
    product_.resize(3 * nodes_.size());
  }

  /** q += C p for flat vectors, 3 numbers a node. @return p . C p */
  double addProduct(const PcgKernels<Real>& kernels, const Real* p, Real* q)
  {
    constexpr Index kGrain = 128;
    return parallelSum(rows_.rows(), kGrain, [&](Index begin, Index end) {
      kernels.multiplyRows(rows_.view(), begin, end, p, product_.data());
      double sum = 0.0;
      for (Index i = begin; i < end; ++i)
      {
        const Real* from = product_.data() + 3 * static_cast<std::size_t>(i);
        for (int k = 0; k < 3; ++k)
        {
          q[3 * nodes_[i] + k] += from[k];
          sum += static_cast<double>(p[3 * nodes_[i] + k]) * from[k];
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
  std::vector<double> blocks_;
  std::vector<Index> nodes_;  ///< of the rows
  PackedRows<Real> rows_;
  std::vector<Real> product_;
};

}  // namespace soft_tissue
