/**
 * Stiffness of quadratic tets. Included by kernel files only (see pack.h).
 *
 * The gradients of the shape functions are sums of those of the linear ones, b_k: (4 L_k - 1) b_k
 * of vertex k and 4 (L_k b_l + L_l b_k) of the edge kl. So the blocks are sums over Gauss points q
 * of K_q(k, l), the blocks of the linear tet with the F of that point. With kFar and kNear in L,
 * U_q = 16 kFar kNear K_q, r = kNear / (4 kFar) and S = (U_0 + U_1 + U_2 + U_3) / 4r,
 *   sum_q 16 L_m L_n K_q         = S + U_m + U_n           or, m = n,  S + (2 + 4 r) U_m
 *   sum_q (4 L_m - 1) 4 L_n K_q  = U_m - r (S + U_n)       or, m = n,  (1 + 3 r) U_m - r S
 *   sum_q (4 L_m - 1)(4 L_n - 1) K_q = r r S - r (U_m + U_n)  or, m = n,  r r S + 2 r U_m.
 */
#pragma once

#include <algorithm>

#include "quadratic_lanes.h"
#include "soft_tissue_sim/mesh/quadratic_tets.h"
#include "stiffness_blocks.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
constexpr std::array<BlockNodes, kQuadraticTetBlocks> upperBlocks()
{
  std::array<BlockNodes, kQuadraticTetBlocks> blocks = {};
  int count = 0;
  for (int a = 0; a < 10; ++a)
  {
    for (int b = a; b < 10; ++b)
    {
      blocks[count][0] = a;
      blocks[count++][1] = b;
    }
  }
  return blocks;
}

/** Nodes of the blocks of a quadratic tet. */
constexpr std::array<BlockNodes, kQuadraticTetBlocks> kQuadraticBlocks = upperBlocks();

/** Blocks made before they are added together: nine values of each fill whole squares of packs. */
constexpr int kBatch = 8;

/** Values of all blocks of a tet, batches filled up. */
constexpr int kRow = 9 * ((kQuadraticTetBlocks + kBatch - 1) / kBatch * kBatch);

/** Sums over the Gauss points of a few tets, a block K(k, l) of linear shape functions at a time.
 */
class GaussSums
{
 public:
  static constexpr double kRatio = kNear / (4.0 * kFar);
  static constexpr int kTable = 9 * kTetBlocks;

  /** Of a point, times 16 kFar kNear. */
  Pack* table(int point) { return tables_[point]; }

  void finish()
  {
    for (int k = 0; k < kTable; ++k)
    {
      all_[k] = ((tables_[0][k] + tables_[1][k]) + (tables_[2][k] + tables_[3][k])) *
                (1.0 / (4.0 * kRatio));
    }
  }

  /** One block of the tet, nodes in the order of QuadraticTet. */
  void block(const BlockNodes& nodes, Pack* out) const
  {
    const int a = nodes[0], b = nodes[1];
    if (b < 4)
    {
      vertices(a, b, out);
      return;
    }
    const int* to = kTetEdges[b - 4];
    if (a < 4)
    {
      vertexEdge<false>(a, to[0], to[1], out);
      vertexEdge<true>(a, to[1], to[0], out);
      return;
    }
    const int* from = kTetEdges[a - 4];
    edges<false>(from[0], to[0], from[1], to[1], out);
    edges<true>(from[0], to[1], from[1], to[0], out);
    edges<true>(from[1], to[0], from[0], to[1], out);
    edges<true>(from[1], to[1], from[0], to[0], out);
  }

 private:
  /** Where block (k, l) starts in a table, and the step to the next of its nine values: those
   * below the diagonal are transposed. */
  static constexpr int kStart[4][4] = {
      {0, 36, 45, 54}, {36, 9, 63, 72}, {45, 63, 18, 81}, {54, 72, 81, 27}};
  static constexpr int kOrder[2][9] = {{0, 1, 2, 3, 4, 5, 6, 7, 8}, {0, 3, 6, 1, 4, 7, 2, 5, 8}};

  void vertices(int m, int n, Pack* out) const
  {
    const Pack* s = all_ + kStart[m][n];
    const Pack* um = tables_[m] + kStart[m][n];
    const Pack* un = tables_[n] + kStart[m][n];
    for (int k = 0; k < 9; ++k)
    {
      out[k] =
          (kRatio * kRatio) * s[k] + (m == n ? 2.0 * kRatio * um[k] : -kRatio * (um[k] + un[k]));
    }
  }

  /** (4 L_m - 1) 4 L_n K(m, l) */
  template <bool kAdd>
  void vertexEdge(int m, int n, int l, Pack* out) const
  {
    const int* order = kOrder[m > l];
    const Pack* s = all_ + kStart[m][l];
    const Pack* um = tables_[m] + kStart[m][l];
    const Pack* un = tables_[n] + kStart[m][l];
    for (int k = 0; k < 9; ++k)
    {
      const int from = order[k];
      const Pack value = m == n ? (1.0 + 3.0 * kRatio) * um[from] - kRatio * s[from]
                                : um[from] - kRatio * (s[from] + un[from]);
      out[k] = kAdd ? out[k] + value : value;
    }
  }

  /** 16 L_m L_n K(k, l) */
  template <bool kAdd>
  void edges(int m, int n, int i, int l, Pack* out) const
  {
    const int* order = kOrder[i > l];
    const Pack* s = all_ + kStart[i][l];
    const Pack* um = tables_[m] + kStart[i][l];
    const Pack* un = tables_[n] + kStart[i][l];
    for (int k = 0; k < 9; ++k)
    {
      const int from = order[k];
      const Pack value =
          m == n ? s[from] + (2.0 + 4.0 * kRatio) * um[from] : s[from] + (um[from] + un[from]);
      out[k] = kAdd ? out[k] + value : value;
    }
  }

  Pack tables_[kGaussPoints][kTable];
  Pack all_[kTable];
};

/** Asks for the blocks of a few tets while there is something else to do. */
template <int kBlockCount>
inline void prefetchBlocks(const Index* positions, const double* values)
{
  for (int block = 0; block < kBlockCount; ++block, positions += kTetLanes)
  {
    for (int lane = 0; lane < kLanes; ++lane)
    {
      const double* at = values + 9 * static_cast<long>(positions[lane]);
      __builtin_prefetch(at, 1);
      __builtin_prefetch(at + 8, 1);
    }
  }
}

template <typename Material, bool kProjected>
void quadraticStiffness(const TetGroups& groups, Index begin, Index end, const double* x,
                        const Index* positions, double* values)
{
  forQuadraticLanes<Material>(
      groups, begin, end, x, [&](Index group, int lane, QuadraticLanes<Material>& t) {
        const Index* place =
            positions + kTetLanes * kQuadraticTetBlocks * static_cast<long>(group) + lane;
        prefetchBlocks<kQuadraticTetBlocks>(place, values);
        GaussSums sums;
        t.at.volume *= 16.0 * kFar * kNear;
        forGaussPoints<Material>(groups, group, lane, t, [&](int k, const Lanes<Material>& at) {
          materialBlocks<Material, kProjected>(at, sums.table(k));
        });
        sums.finish();
        alignas(64) double rows[kLanes][kRow];
        for (int first = 0; first < kQuadraticTetBlocks; first += kBatch)
        {
          Pack out[9 * kBatch];
          for (int k = 0; k < kBatch; ++k)
          {
            // The last batch is filled up with what nobody reads.
            const int block = std::min(first + k, kQuadraticTetBlocks - 1);
            sums.block(kQuadraticBlocks[block], out + 9 * k);
          }
          transposeInto<9 * kBatch>(out, rows, 9 * first);
        }
        addBlocks<kQuadraticTetBlocks>(rows, place, values);
      });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
