#pragma once

#include <vector>

#include "soft_tissue_sim/energy/outer_products.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** A block above the diagonal, outside the fixed pattern: what nodes of different elements do to
 * each other where they touch. */
struct Coupling
{
  Index row = 0;
  Index column = 0;  ///< > row
  Mat3 block;
};

/**
 * Square symmetric matrix of 3 x 3 blocks with a fixed pattern: one block row per node, a block for
 * each pair of nodes that share an element and for each node itself. The pattern has both
 * triangles; of the numbers those of blocks with row <= column count. Blocks outside the pattern,
 * which come and go with contact, are a list of couplings; and what couples all nodes of several
 * elements are outer products. The matrix is the sum of all three.
 */
class BlockMatrix
{
 public:
  BlockMatrix() = default;
  /** Pattern: row i holds i itself and all of neighbours' row i. */
  explicit BlockMatrix(const Adjacency& neighbours);

  Index rows() const { return static_cast<Index>(offsets_.size()) - 1; }
  /** All numbers; no couplings, no outer products. */
  void setZero();

  /** Position of block (row, column) in blocks(), or -1 outside the pattern. O(log row length). */
  Index find(Index row, Index column) const;
  Index diagonal(Index row) const { return diagonal_[row]; }
  /** Position of block (column, row) for a block (row, column) on or below the diagonal. */
  Index mirror(Index position) const { return mirror_[position]; }

  /** Column-major 9 doubles of one block. */
  double* block(Index position) { return values_.data() + 9 * static_cast<std::size_t>(position); }
  const double* block(Index position) const
  {
    return values_.data() + 9 * static_cast<std::size_t>(position);
  }

  /** Adds B at (row, column): in the pattern, or else to the couplings. @throws Error unless row <=
   * column */
  void add(Index row, Index column, const Mat3& b);

  /** Each place once, in the order of their first addition. */
  const std::vector<Coupling>& couplings() const { return couplings_; }
  std::vector<Coupling>& couplings() { return couplings_; }

  const OuterProducts& outer() const { return outer_; }
  OuterProducts& outer() { return outer_; }

  const std::vector<Index>& offsets() const { return offsets_; }
  const std::vector<Index>& columns() const { return columns_; }
  const std::vector<double>& values() const { return values_; }
  std::vector<double>& values() { return values_; }

 private:
  std::vector<Index> offsets_;   ///< rows + 1
  std::vector<Index> columns_;   ///< ascending within a row
  std::vector<Index> diagonal_;  ///< rows
  std::vector<Index> mirror_;    ///< per block on or below the diagonal: its transpose's position
  std::vector<double> values_;   ///< 9 per block, and 3 more so that wide loads stay inside
  std::vector<Coupling> couplings_;
  std::vector<Index> row_coupling_;   ///< rows: the last coupling of the row, or -1
  std::vector<Index> next_coupling_;  ///< per coupling: the one before it in its row, or -1
  OuterProducts outer_;
};

}  // namespace soft_tissue
