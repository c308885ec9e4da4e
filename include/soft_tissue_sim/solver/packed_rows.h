#pragma once

#include <vector>

#include "soft_tissue_sim/energy/block_matrix.h"
#include "soft_tissue_sim/solver/pcg_kernels.h"

namespace soft_tissue
{
/** A block matrix in the form that PcgKernels multiply by: its pattern is given once, row by row,
 * its numbers as often as they change. */
template <typename Real>
class PackedRows
{
 public:
  /** Forgets all rows. */
  void clear()
  {
    offsets_.assign(1, 0);
    columns_.clear();
    sources_.clear();
  }

  /** Another block of the row that the next endRow() ends: number `source` of what load() takes,
   * or that one's transpose. */
  void add(Index column, Index source, bool transposed)
  {
    columns_.push_back(column);
    sources_.push_back(transposed ? ~source : source);
  }

  void endRow()
  {
    if (columns_.size() % 2 == 1)
    {
      columns_.push_back(columns_.back());
      sources_.push_back(kNoBlock);
    }
    offsets_.push_back(static_cast<Index>(columns_.size() / 2));
  }

  /** After the last row. */
  void finish() { values_.assign(kPair * columns_.size() / 2, Real(0)); }

  /**
   * Has the pattern of a matrix, of whose values() load() is given the numbers.
   * @param nodes  the order that its rows and columns come in
   * @param place  of each node in that order
   */
  void takePattern(const BlockMatrix& a, const std::vector<Index>& nodes,
                   const std::vector<Index>& place)
  {
    clear();
    for (const Index row : nodes)
    {
      for (Index k = a.offsets()[row]; k < a.offsets()[row + 1]; ++k)
      {
        const bool below = k < a.diagonal(row);
        add(place[a.columns()[k]], below ? a.mirror(k) : k, below);
      }
      endRow();
    }
    finish();
  }

  Index rows() const { return static_cast<Index>(offsets_.size()) - 1; }

  /** Takes the numbers of rows begin ... end - 1. @param blocks  9 each by columns, and one more
   * readable number */
  void load(const PcgKernels<Real>& kernels, const double* blocks, Index begin, Index end)
  {
    kernels.pack(blocks, sources_.data(), 2 * offsets_[begin], 2 * offsets_[end], values_.data());
  }

  BlockRows<Real> view() const { return {offsets_.data(), columns_.data(), values_.data()}; }

 private:
  static constexpr std::size_t kPair = 24;

  std::vector<Index> offsets_ = {0};  ///< rows + 1, in pairs
  std::vector<Index> columns_;
  std::vector<Index> sources_;  ///< per column, see PcgKernels::pack
  std::vector<Real> values_;
};

}  // namespace soft_tissue
