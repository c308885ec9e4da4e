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
/** A few tets of one group, deformed. */
struct DeformedLanes
{
  PackMat gradients;  ///< rows: rest gradients of the shape functions of nodes 1, 2, 3
  PackMat f;          ///< deformation gradient
  Pack volume;
};

/** What they need to be evaluated at x. */
template <typename Material>
struct Lanes : DeformedLanes
{
  Pack constants[Material::kConstants];  ///< of the law; or of a point, of what it remembers
};

/** Positions of the kNodes nodes of each of a few tets: gathered[3 node + axis][lane]. */
template <int kNodes>
SOFT_TISSUE_INLINE void gather(const TetGroups& groups, Index group, int lane, const double* x,
                               double (*gathered)[kLanes])
{
  const Index* nodes = groups.nodes + kTetLanes * kNodes * static_cast<long>(group) + lane;
  for (int node = 0; node < kNodes; ++node)
  {
    for (int l = 0; l < kLanes; ++l)
    {
      const double* p = x + 3 * static_cast<long>(nodes[kTetLanes * node + l]);
      gathered[3 * node + 0][l] = p[0];
      gathered[3 * node + 1][l] = p[1];
      gathered[3 * node + 2][l] = p[2];
    }
  }
}

/** Constants of a law, or of one of the points of what tets remember. */
template <typename Material>
SOFT_TISSUE_INLINE void loadConstants(const TetGroups& groups, long place, int lane,
                                      Lanes<Material>& lanes)
{
  for (int k = 0; k < Material::kConstants; ++k)
  {
    lanes.constants[k] = load(groups.constants + 8 * (Material::kConstants * place + k) + lane);
  }
}

/** All but F and the constants. */
SOFT_TISSUE_INLINE void loadRest(const TetGroups& groups, Index group, int lane,
                                 DeformedLanes& lanes)
{
  const double* gradients = groups.gradients + 72 * static_cast<long>(group) + lane;
  for (int k = 0; k < 9; ++k)
  {
    lanes.gradients.m[k / 3][k % 3] = load(gradients + 8 * k);
  }
  lanes.volume = load(groups.volumes + 8 * static_cast<long>(group) + lane);
}

template <typename Material>
SOFT_TISSUE_INLINE Lanes<Material> loadLanes(const TetGroups& groups, Index group, int lane,
                                             const double* x)
{
  Lanes<Material> lanes;
  double gathered[12][kLanes];
  gather<4>(groups, group, lane, x, gathered);
  loadRest(groups, group, lane, lanes);
  loadConstants(groups, group, lane, lanes);
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
  return lanes;
}

/** Calls body(group, lane, lanes) for all lanes of groups begin ... end - 1. */
template <typename Material, typename Body>
inline void forLanes(const TetGroups& groups, Index begin, Index end, const double* x,
                     const Body& body)
{
  for (Index group = begin; group < end; ++group)
  {
    for (int lane = 0; lane < kTetLanes; lane += kLanes)
    {
      body(group, lane, loadLanes<Material>(groups, group, lane, x));
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
SOFT_TISSUE_INLINE void exchange(Pack& a, Pack& b, std::integer_sequence<int, kLane...>)
{
  const Pack old = a;
  a = __builtin_shuffle(old, b, Mask{(kLane & kSize ? kLane - kSize + kLanes : kLane)...});
  b = __builtin_shuffle(old, b, Mask{(kLane & kSize ? kLane + kLanes : kLane + kSize)...});
}

/** Turns the square of packs at v[0] ... v[kLanes - 1]: lane j of pack i becomes lane i of pack j.
 */
template <int kSize = 1>
SOFT_TISSUE_INLINE void transposeSquare(Pack* v)
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

/** rows[lane][first + k] = value[k] of each lane; value holds padded(kCount) packs and is used up.
 */
template <int kCount, std::size_t kRow>
SOFT_TISSUE_INLINE void transposeInto(Pack* value, double (*rows)[kRow], int first)
{
  for (int k = 0; k < kCount; k += kLanes)
  {
    transposeSquare(value + k);
    for (int lane = 0; lane < kLanes; ++lane)
    {
      store(rows[lane] + first + k, value[k + lane]);
    }
  }
}

template <int kCount>
SOFT_TISSUE_INLINE void transpose(Pack* value, double (*rows)[padded(kCount)])
{
  transposeInto<kCount>(value, rows, 0);
}

/** Adds the forces g[3 node + axis] of a few tets to their nodes; uses g up. */
template <int kNodes>
SOFT_TISSUE_INLINE void scatter(const TetGroups& groups, Index group, int lane, Pack* g,
                                double* gradient)
{
  constexpr int kSize = 3 * kNodes;
  for (int k = kSize; k < padded(kSize); ++k)
  {
    g[k] = Pack{};
  }
  alignas(64) double rows[kLanes][padded(kSize)];
  transpose<kSize>(g, rows);
  const Index* nodes = groups.nodes + kTetLanes * kNodes * static_cast<long>(group) + lane;
  for (int l = 0; l < kLanes; ++l)
  {
    for (int node = 0; node < kNodes; ++node)
    {
      double* at = gradient + 3 * static_cast<long>(nodes[kTetLanes * node + l]);
      at[0] += rows[l][3 * node + 0];
      at[1] += rows[l][3 * node + 1];
      at[2] += rows[l][3 * node + 2];
    }
  }
}

/** Equivalent (von Mises) stress of the Cauchy stress P F^T / J; told even where J <= 0. The linear
 * law knows one stress only. */
template <typename Material>
inline Pack vonMises(const PackMat& f, const Pack* constants)
{
  constexpr bool kIsCauchy = Material::kForm == Form::linear;
  const PackMat p = Material::stress(f, constants);
  PackMat s = p;
  for (int a = 0; a < 3 && !kIsCauchy; ++a)
  {
    for (int b = 0; b < 3; ++b)
    {
      s.m[a][b] = p.m[a][0] * f.m[b][0] + p.m[a][1] * f.m[b][1] + p.m[a][2] * f.m[b][2];
    }
  }
  const Pack d0 = s.m[0][0] - s.m[1][1], d1 = s.m[1][1] - s.m[2][2], d2 = s.m[2][2] - s.m[0][0];
  const Pack shear = s.m[0][1] * s.m[0][1] + s.m[1][2] * s.m[1][2] + s.m[0][2] * s.m[0][2];
  const Pack size = sqrt(0.5 * (d0 * d0 + d1 * d1 + d2 * d2) + 3.0 * shear);
  return kIsCauchy ? size : size / max(abs(determinant(f)), splat(1e-12));
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
