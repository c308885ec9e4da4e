/**
 * Quadratic tets in and out of registers, several at once. Included by kernel files only (see
 * pack.h).
 *
 * With edges straight at rest F is linear in a tet: F = sum_k L_k F_k with the barycentric
 * coordinates L and F_k at vertex k. F_k is that of a linear tet whose edges from node 0 are
 * d_k1, d_k2, d_k3: with u_a = x_a - x_0, numbers of nodes for those of vertices and of edges,
 *   d_kj = 4 (u_kj - u_0k) - u_j for j != k,  d_kk = 3 u_k - 4 u_0k,  d_0j = 4 u_0j - u_j.
 */
#pragma once

#include "tet_lanes.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** The four Gauss points, of a quarter of the volume each: L is kFar but in one vertex, and there
 * kFar + kNear. Exact for quadratic functions. */
constexpr double kFar = 0.13819660112501052;   // (5 - sqrt 5) / 20
constexpr double kNear = 0.44721359549995793;  // 1 / sqrt 5
constexpr int kGaussPoints = 4;

/** Number of the node between two vertices. */
constexpr int kBetween[4][4] = {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}};

/** What a few quadratic tets of one group need to be evaluated at x. */
template <typename Material>
struct QuadraticLanes
{
  Lanes<Material> at;   ///< of a point: its F, and a quarter of the volume
  Pack edges[3][4][3];  ///< [axis][k][j]: d_kj, edges at vertex k
};

template <typename Material>
SOFT_TISSUE_INLINE void loadLanes(const TetGroups& groups, Index group, int lane, const double* x,
                                  QuadraticLanes<Material>& t)
{
  double gathered[30][kLanes];
  gather<10>(groups, group, lane, x, gathered);
  loadRest(groups, group, lane, t.at);
  t.at.volume *= 0.25;
  for (int i = 0; i < 3; ++i)
  {
    const Pack x0 = load(gathered[i]);
    Pack u[10];
    for (int a = 1; a < 10; ++a)
    {
      u[a] = load(gathered[3 * a + i]) - x0;
    }
    for (int j = 1; j < 4; ++j)
    {
      t.edges[i][0][j - 1] = 4.0 * u[kBetween[0][j]] - u[j];
      for (int k = 1; k < 4; ++k)
      {
        t.edges[i][k][j - 1] = j == k ? 3.0 * u[k] - 4.0 * u[kBetween[0][k]]
                                      : 4.0 * (u[kBetween[k][j]] - u[kBetween[0][k]]) - u[j];
      }
    }
  }
}

/** F of a linear tet with these edges, [axis][3]. */
SOFT_TISSUE_INLINE void deform(const Pack (*edges)[3], DeformedLanes& t)
{
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      t.f.m[i][j] = edges[i][0] * t.gradients.m[0][j] + edges[i][1] * t.gradients.m[1][j] +
                    edges[i][2] * t.gradients.m[2][j];
    }
  }
}

/** Calls body(k, t) at each Gauss point k, t with its F, and with its constants where each has its
 * own. */
template <typename Material, typename Body>
inline void forGaussPoints(const TetGroups& groups, Index group, int lane,
                           QuadraticLanes<Material>& t, const Body& body)
{
  Pack far[3][3];
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      far[i][j] =
          kFar * ((t.edges[i][0][j] + t.edges[i][1][j]) + (t.edges[i][2][j] + t.edges[i][3][j]));
    }
  }
#pragma GCC unroll 1
  for (int k = 0; k < kGaussPoints; ++k)
  {
    Pack edges[3][3];
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        edges[i][j] = far[i][j] + kNear * t.edges[i][k][j];
      }
    }
    deform(edges, t.at);
    if constexpr (Material::kForm == Form::strain)
    {
      loadConstants(groups, kGaussPoints * static_cast<long>(group) + k, lane, t.at);
    }
    body(k, t.at);
  }
}

/** Calls body(group, lane, lanes) for all lanes of groups begin ... end - 1. */
template <typename Material, typename Body>
inline void forQuadraticLanes(const TetGroups& groups, Index begin, Index end, const double* x,
                              const Body& body)
{
  for (Index group = begin; group < end; ++group)
  {
    for (int lane = 0; lane < kTetLanes; lane += kLanes)
    {
      QuadraticLanes<Material> t;
      loadLanes(groups, group, lane, x, t);
      if constexpr (Material::kForm != Form::strain)
      {
        loadConstants(groups, group, lane, t.at);
      }
      body(group, lane, t);
    }
  }
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
