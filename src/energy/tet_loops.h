/**
 * Element loops over groups of linear tets, whatever the law. Included by kernel files only (see
 * pack.h).
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
  forLanes<Material>(groups, begin, end, x, [&](Index group, int lane, const Lanes<Material>& t) {
    store(energies + 8 * static_cast<long>(group) + lane,
          t.volume * Material::energy(t.f, t.constants));
  });
}

template <typename Material>
void tetGradient(const TetGroups& groups, Index begin, Index end, const double* x, double* gradient,
                 double* energies)
{
  forLanes<Material>(groups, begin, end, x, [&](Index group, int lane, const Lanes<Material>& t) {
    Pack density;
    const PackMat p = stressAndEnergy<Material>(t.f, t.constants, density);
    store(energies + 8 * static_cast<long>(group) + lane, t.volume * density);
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
    scatter<4>(groups, group, lane, g, gradient);
  });
}

template <typename Material>
void tetState(const TetGroups& groups, Index begin, Index end, const double* x, double* det_f,
              double* von_mises)
{
  forLanes<Material>(groups, begin, end, x, [&](Index group, int lane, const Lanes<Material>& t) {
    const long at = 8 * static_cast<long>(group) + lane;
    store(det_f + at, determinant(t.f));
    if (von_mises != nullptr)
    {
      store(von_mises + at, vonMises<Material>(t.f, t.constants));
    }
  });
}

template <typename Material>
void tetRemember(const TetGroups& groups, Index begin, Index end, const double* x, double* six)
{
  forLanes<Material>(groups, begin, end, x, [&](Index group, int lane, const Lanes<Material>& t) {
    remember<Material>(t.f, t.constants, six + 6 * kTetLanes * static_cast<long>(group) + lane);
  });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
