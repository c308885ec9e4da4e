/**
 * Element loops over groups of tets, compiled once per instruction set by tet_kernels_*.cpp, which
 * define SOFT_TISSUE_KERNELS (a namespace of their own) and SOFT_TISSUE_LANES (doubles worked on at
 * once, a divisor of 8).
 */
#pragma once

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

/** Writes value[k] of each lane to out + stride * tet + k. */
template <int kCount>
inline void storeTransposed(const Pack* value, Index group, int lane, double* out)
{
  double* first = out + kCount * (8 * static_cast<long>(group) + lane);
  for (int l = 0; l < kLanes; ++l)
  {
    for (int k = 0; k < kCount; ++k)
    {
      first[kCount * l + k] = value[k][l];
    }
  }
}

template <typename Material>
void tetEnergy(const TetGroups& groups, Index begin, Index end, const double* x, double* energies)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    store(energies + 8 * static_cast<long>(group) + lane,
          t.volume * Material::energy(t.f, t.constants));
  });
}

template <typename Material>
void tetGradient(const TetGroups& groups, Index begin, Index end, const double* x,
                 double* gradients)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    const PackMat p = Material::stress(t.f, t.constants);
    Pack g[12];
    for (int i = 0; i < 3; ++i)
    {
      for (int node = 1; node < 4; ++node)
      {
        const Pack* b = t.gradients.m[node - 1];
        g[3 * node + i] = t.volume * (p.m[i][0] * b[0] + p.m[i][1] * b[1] + p.m[i][2] * b[2]);
      }
      g[i] = -(g[3 + i] + g[6 + i] + g[9 + i]);
    }
    storeTransposed<12>(g, group, lane, gradients);
  });
}

/** U K U^T, K given in the frame of the left singular vectors. */
inline PackMat rotateBlock(const PackMat& u, const PackMat& k)
{
  PackMat uk, r;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      uk.m[i][j] = u.m[i][0] * k.m[0][j] + u.m[i][1] * k.m[1][j] + u.m[i][2] * k.m[2][j];
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      r.m[i][j] = uk.m[i][0] * u.m[j][0] + uk.m[i][1] * u.m[j][1] + uk.m[i][2] * u.m[j][2];
    }
  }
  return r;
}

/** The three 2 x 2 blocks of the second derivative that mix F_ij and F_ji: [[same, cross], [cross,
 * same]]. */
struct MixedStiffness
{
  Pack same[3];
  Pack cross[3];
};

/** Block (a, b) in the frame of the singular vectors, from the nodes' shape gradients there. */
inline PackMat principalBlock(const PackMat& h, const MixedStiffness& mixed, const Pack* da,
                              const Pack* db)
{
  PackMat k;
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3, l = (i + 2) % 3;
    k.m[i][i] =
        h.m[i][i] * da[i] * db[i] + mixed.same[l] * da[j] * db[j] + mixed.same[j] * da[l] * db[l];
    k.m[i][j] = h.m[i][j] * da[i] * db[j] + mixed.cross[l] * da[j] * db[i];
    k.m[i][l] = h.m[i][l] * da[i] * db[l] + mixed.cross[j] * da[l] * db[i];
  }
  return k;
}

template <typename Material>
void tetStiffness(const TetGroups& groups, Index begin, Index end, const double* x,
                  double* stiffness)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    const Pack zero = {};
    const Svd svd = signedSvd(t.f);
    PrincipalStiffness k = Material::principal(svd.sigma, t.constants);
    projectSymmetric(k.hessian);
    MixedStiffness mixed;
    for (int i = 0; i < 3; ++i)
    {
      const Pack even = t.volume * max(k.difference[i], zero), odd = t.volume * max(k.sum[i], zero);
      mixed.same[i] = 0.5 * (even + odd);
      mixed.cross[i] = 0.5 * (even - odd);
      for (int j = 0; j < 3; ++j)
      {
        k.hessian.m[i][j] *= t.volume;
      }
    }
    PackMat d;  // rows: shape gradients of nodes 1, 2, 3 in the frame of the right singular vectors
    for (int a = 0; a < 3; ++a)
    {
      for (int j = 0; j < 3; ++j)
      {
        d.m[a][j] = t.gradients.m[a][0] * svd.v.m[0][j] + t.gradients.m[a][1] * svd.v.m[1][j] +
                    t.gradients.m[a][2] * svd.v.m[2][j];
      }
    }
    Pack out[kTetStiffnessSize];
    PackMat row[3] = {};  // row sums of the blocks of nodes 1, 2, 3: minus the blocks with node 0
    for (int a = 0; a < 3; ++a)
    {
      for (int b = a; b < 3; ++b)
      {
        const PackMat block = rotateBlock(svd.u, principalBlock(k.hessian, mixed, d.m[a], d.m[b]));
        for (int i = 0; i < 3; ++i)
        {
          for (int j = 0; j < 3; ++j)
          {
            row[a].m[i][j] += block.m[i][j];
            if (b != a)
            {
              row[b].m[i][j] += block.m[j][i];
              out[offDiagonalBlockOffset(a + 1, b + 1) + 3 * j + i] = block.m[i][j];
            }
          }
        }
        if (a == b)
        {
          Pack* place = out + diagonalBlockOffset(a + 1);
          place[0] = block.m[0][0];
          place[1] = block.m[1][0];
          place[2] = block.m[2][0];
          place[3] = block.m[1][1];
          place[4] = block.m[2][1];
          place[5] = block.m[2][2];
        }
      }
    }
    PackMat corner = {};
    for (int a = 0; a < 3; ++a)
    {
      for (int i = 0; i < 3; ++i)
      {
        for (int j = 0; j < 3; ++j)
        {
          corner.m[i][j] += row[a].m[i][j];
          out[offDiagonalBlockOffset(0, a + 1) + 3 * j + i] = -row[a].m[j][i];
        }
      }
    }
    out[0] = corner.m[0][0];
    out[1] = corner.m[1][0];
    out[2] = corner.m[2][0];
    out[3] = corner.m[1][1];
    out[4] = corner.m[2][1];
    out[5] = corner.m[2][2];
    storeTransposed<kTetStiffnessSize>(out, group, lane, stiffness);
  });
}

template <typename Material>
void tetState(const TetGroups& groups, Index begin, Index end, const double* x, double* det_f,
              double* von_mises)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    const Pack j = determinant(t.f);
    store(det_f + 8 * static_cast<long>(group) + lane, j);
    if (von_mises == nullptr)
    {
      return;
    }
    // Cauchy stress P F^T / J; its size is told even where J <= 0.
    const PackMat p = Material::stress(t.f, t.constants);
    PackMat s;
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; b < 3; ++b)
      {
        s.m[a][b] = p.m[a][0] * t.f.m[b][0] + p.m[a][1] * t.f.m[b][1] + p.m[a][2] * t.f.m[b][2];
      }
    }
    const Pack d0 = s.m[0][0] - s.m[1][1], d1 = s.m[1][1] - s.m[2][2], d2 = s.m[2][2] - s.m[0][0];
    const Pack shear = s.m[0][1] * s.m[0][1] + s.m[1][2] * s.m[1][2] + s.m[0][2] * s.m[0][2];
    const Pack size = sqrt(0.5 * (d0 * d0 + d1 * d1 + d2 * d2) + 3.0 * shear);
    store(von_mises + 8 * static_cast<long>(group) + lane, size / max(abs(j), splat(1e-12)));
  });
}

template <typename Material>
const TetKernels& kernelsOf()
{
  static const TetKernels kernels = {Material::constants, tetEnergy<Material>,
                                     tetGradient<Material>, tetStiffness<Material>,
                                     tetState<Material>};
  return kernels;
}

const TetKernels& kernelsFor(MaterialModel model)
{
  switch (model)
  {
    case MaterialModel::corotated:
      return kernelsOf<Corotated>();
    default:
      return kernelsOf<NeoHookean>();
  }
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
