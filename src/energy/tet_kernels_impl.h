/**
 * Element loops over groups of tets, compiled once per instruction set by tet_kernels_*.cpp, which
 * define SOFT_TISSUE_KERNELS (a namespace of their own) and SOFT_TISSUE_LANES (doubles worked on at
 * once, a divisor of 8).
 */
#pragma once

#include "tet_lanes.h"
#include "tet_stiffness_impl.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
template <typename Material>
void tetEnergy(const TetGroups& groups, Index begin, Index end, const double* x, double* energies)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    store(energies + 8 * static_cast<long>(group) + lane,
          t.volume * Material::energy(t.f, t.constants));
  });
}

template <typename Material>
void tetGradient(const TetGroups& groups, Index begin, Index end, const double* x, double* gradient,
                 double* energies)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    store(energies + 8 * static_cast<long>(group) + lane,
          t.volume * Material::energy(t.f, t.constants));
    const PackMat p = Material::stress(t.f, t.constants);
    Pack g[padded(12)];
    for (int i = 0; i < 3; ++i)
    {
      for (int node = 1; node < 4; ++node)
      {
        const Pack* b = t.gradients.m[node - 1];
        g[3 * node + i] = t.volume * (p.m[i][0] * b[0] + p.m[i][1] * b[1] + p.m[i][2] * b[2]);
      }
      g[i] = -(g[3 + i] + g[6 + i] + g[9 + i]);
    }
    for (int k = 12; k < padded(12); ++k)
    {
      g[k] = Pack{};
    }
    alignas(64) double rows[kLanes][padded(12)];
    transpose<12>(g, rows);
    const Index* nodes = groups.nodes + 32 * static_cast<long>(group) + lane;
    for (int l = 0; l < kLanes; ++l)
    {
      for (int node = 0; node < 4; ++node)
      {
        double* at = gradient + 3 * static_cast<long>(nodes[8 * node + l]);
        at[0] += rows[l][3 * node + 0];
        at[1] += rows[l][3 * node + 1];
        at[2] += rows[l][3 * node + 2];
      }
    }
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
  static const TetKernels kernels = {Material::constants,
                                     tetEnergy<Material>,
                                     tetGradient<Material>,
                                     tetStiffness<Material>,
                                     tetProjectedStiffness<Material>,
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
