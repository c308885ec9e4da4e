/**
 * Tets in and out of registers, several at once. Included by kernel files only (see pack.h).
 */
#pragma once

#include <utility>

#include "materials.h"
#include "soft_tissue_sim/energy/tet_kernels.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** What a few tets of one group need to be evaluated at x. */
struct Lanes
{
  PackMat gradients;  ///< rows: rest gradients of the shape functions of nodes 1, 2, 3
  PackMat f;          ///< deformation gradient
  Pack volume;
  Pack constants[kMaterialConstants];
};

inline Lanes loadLanes(const TetGroups& groups, Index group, int lane, const double* x)
{
  Lanes lanes;
  const Index* nodes = groups.nodes + 32 * group + lane;
  double gathered[12][kLanes];
  for (int node = 0; node < 4; ++node)
  {
    for (int l = 0; l < kLanes; ++l)
    {
      const double* p = x + 3 * static_cast<long>(nodes[8 * node + l]);
      gathered[3 * node + 0][l] = p[0];
      gathered[3 * node + 1][l] = p[1];
      gathered[3 * node + 2][l] = p[2];
    }
  }
  const double* gradients = groups.gradients + 72 * static_cast<long>(group) + lane;
  for (int k = 0; k < 9; ++k)
  {
    lanes.gradients.m[k / 3][k % 3] = load(gradients + 8 * k);
  }
  for (int i = 0; i < 3; ++i)
  {
    const Pack x0 = load(gathered[i]);
    const Pack e1 = load(gathered[3 + i]) - x0;
    const Pack e2 = load(gathered[6 + i]) - x0;
    const Pack e3 = load(gathered[9 + i]) - x0;
    for (int j = 0; j < 3; ++j)
    {
      lanes.f.m[i][j] = e1 * lanes.gradients.m[0][j] + e2 * lanes.gradients.m[1][j] +
                        e3 * lanes.gradients.m[2][j];
    }
  }
  lanes.volume = load(groups.volumes + 8 * static_cast<long>(group) + lane);
  for (int k = 0; k < kMaterialConstants; ++k)
  {
    lanes.constants[k] =
        load(groups.constants + 8 * (kMaterialConstants * static_cast<long>(group) + k) + lane);
  }
  return lanes;
}

/** Calls body(group, lane, lanes) for all lanes of groups begin ... end - 1. */
template <typename Body>
inline void forLanes(const TetGroups& groups, Index begin, Index end, const double* x,
                     const Body& body)
{
  for (Index group = begin; group < end; ++group)
  {
    for (int lane = 0; lane < kTetLanes; lane += kLanes)
    {
      body(group, lane, loadLanes(groups, group, lane, x));
    }
  }
}

/** The smallest multiple of the lane count that holds `count`. */
constexpr int padded(int count)
{
  return (count + kLanes - 1) / kLanes * kLanes;
}

/** Exchanges the off-diagonal quarters of each square of 2 kSize lanes of two packs. */
template <int kSize, int... kLane>
inline void exchange(Pack& a, Pack& b, std::integer_sequence<int, kLane...>)
{
  const Pack old = a;
  a = __builtin_shuffle(old, b, Mask{(kLane & kSize ? kLane - kSize + kLanes : kLane)...});
  b = __builtin_shuffle(old, b, Mask{(kLane & kSize ? kLane + kLanes : kLane + kSize)...});
}

/** Turns the square of packs at v[0] ... v[kLanes - 1]: lane j of pack i becomes lane i of pack j.
 */
template <int kSize = 1>
inline void transposeSquare(Pack* v)
{
  for (int i = 0; i < kLanes; ++i)
  {
    if ((i & kSize) == 0)
    {
      exchange<kSize>(v[i], v[i + kSize], std::make_integer_sequence<int, kLanes>());
    }
  }
  if constexpr (2 * kSize < kLanes)
  {
    transposeSquare<2 * kSize>(v);
  }
}

/** rows[lane][k] = value[k] of each lane; value holds padded(kCount) packs and is used up. */
template <int kCount>
inline void transpose(Pack* value, double (*rows)[padded(kCount)])
{
  for (int k = 0; k < kCount; k += kLanes)
  {
    transposeSquare(value + k);
    for (int lane = 0; lane < kLanes; ++lane)
    {
      store(rows[lane] + k, value[k + lane]);
    }
  }
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
