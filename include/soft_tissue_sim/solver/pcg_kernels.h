#pragma once

#include <limits>

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/index.h"

namespace soft_tissue
{
/**
 * A block matrix, both triangles, as plain arrays of float or double: blocks of a row two by two,
 * so that wide registers hold a column of both. Where a row has an odd number, its last one is
 * zero.
 */
template <typename Real>
struct BlockRows
{
  const Index* offsets;  ///< rows + 1: pairs of row i are offsets[i] ... offsets[i + 1] - 1
  const Index* columns;  ///< 2 a pair
  /** 24 a pair: for each of three columns that of the first block, a zero, that of the second, a
   * zero. */
  const Real* values;
};

/** Among the sources of PcgKernels::pack: a block of zeros. */
constexpr Index kNoBlock = std::numeric_limits<Index>::min();

/** What conjugate gradients sum up over nodes: |r|^2 and r . z. */
struct PcgSums
{
  double rr = 0.0;
  double rz = 0.0;
  void operator+=(const PcgSums& other)
  {
    rr += other.rr;
    rz += other.rz;
  }
};

/** Groups of nodes that a coarse level moves like rigid bodies: 6 numbers a group, translation and
 * rotation. */
template <typename Real>
struct NodeGroups
{
  const Index* pieces;  ///< piece k, in one group: nodes pieces[k] ... pieces[k + 1] - 1
  const Index* group;   ///< per node; their number: in none
  const Real* arms;     ///< per node, 3: from the group's centre
};

/**
 * The passes of a conjugate-gradient iteration over nodes begin ... end - 1. Vectors are flat, 3
 * per node; `inverse` is the preconditioner, 9 per node by columns. All that is only read has one
 * more readable number at its end.
 */
template <typename Real>
struct PcgKernels
{
  /** Values of columns begin ... end - 1 of BlockRows, which are zero where no block is: of source
   * s the block s of those given, 9 numbers each by columns; of ~s its transpose. */
  void (*pack)(const double* blocks, const Index* sources, Index begin, Index end, Real* values);
  /** z = D r and its sums. */
  PcgSums (*precondition)(Index begin, Index end, const Real* inverse, const Real* r, Real* z);
  /** q = A p; returns p . q. */
  double (*multiply)(const BlockRows<Real>& a, Index begin, Index end, const Real* p, Real* q);
  /** q = A p where A's rows are not p's: 3 numbers of q a row. */
  void (*multiplyRows)(const BlockRows<Real>& a, Index begin, Index end, const Real* p, Real* q);
  /** d += step p, r -= step q, then q = D r and its sums. */
  PcgSums (*advance)(Index begin, Index end, const Real* inverse, Real step, const Real* p, Real* d,
                     Real* r, Real* q);
  /** p = z + ratio p. */
  void (*turn)(Index begin, Index end, Real ratio, const Real* z, Real* p);
  /** c = P^T r of pieces begin ... end - 1, 6 a piece. */
  void (*gather)(const NodeGroups<Real>& groups, Index begin, Index end, const Real* r, Real* c);
  /** Rows begin ... end - 1 of y = B c for a dense symmetric B of this size. */
  void (*multiplyDense)(Index size, Index begin, Index end, const Real* b, const Real* c, Real* y);
  /** z += P y; y has 6 zeros more for nodes in no group. */
  void (*spread)(const NodeGroups<Real>& groups, Index begin, Index end, const Real* y, Real* z);
};

/** The passes for this machine, Real being float or double; all give the same bits. */
template <typename Real>
const PcgKernels<Real>& pcgKernels(InstructionSet set);

}  // namespace soft_tissue
