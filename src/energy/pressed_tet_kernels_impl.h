/**
 * The kernels of linear tets under a pressure of their own, and the loops for their dilatation;
 * compiled once per instruction set by pressed_tet_kernels_*.cpp, as tet_kernels_impl.h is.
 */
#pragma once

#include "tet_loops.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
template <typename Material>
void tetDilatation(const TetGroups& groups, Index begin, Index end, const double* x,
                   double* dilatations)
{
  forLanes<Material>(groups, begin, end, x, [&](Index group, int lane, const Lanes<Material>& t) {
    store(dilatations + kTetLanes * static_cast<long>(group) + lane, Material::dilatation(t.f));
  });
}

template <typename Material>
void tetDilatationGradient(const TetGroups& groups, Index begin, Index end, const double* x,
                           double* gradients)
{
  forLanes<Material>(groups, begin, end, x, [&](Index group, int lane, const Lanes<Material>& t) {
    const PackMat d = Material::dilatationGradient(t.f);
    double* to = gradients + 12 * kTetLanes * static_cast<long>(group) + lane;
    for (int i = 0; i < 3; ++i)
    {
      Pack others = {};
      for (int node = 1; node < 4; ++node)
      {
        const Pack* b = t.gradients.m[node - 1];
        const Pack here = t.volume * (d.m[i][0] * b[0] + d.m[i][1] * b[1] + d.m[i][2] * b[2]);
        store(to + kTetLanes * (3 * node + i), here);
        others += here;
      }
      store(to + kTetLanes * i, -others);
    }
  });
}

template <typename Material>
void dilatationEnergy(Index begin, Index end, const double* dilatations, double* values,
                      double* slopes, double* curvatures)
{
  for (long k = kTetLanes * static_cast<long>(begin); k < kTetLanes * static_cast<long>(end);
       k += kLanes)
  {
    const VolumeEnergy energy = Material::volumeEnergy(load(dilatations + k));
    store(values + k, energy.value);
    store(slopes + k, energy.slope);
    store(curvatures + k, energy.curvature);
  }
}

const TetKernels& memoryKernels();

template <typename Material>
const TetKernels& pressedKernelsOf()
{
  static const DilatationKernels dilatation = {
      tetDilatation<Material>, tetDilatationGradient<Material>, dilatationEnergy<Material>};
  static const TetKernels kernels = {4,
                                     1,
                                     1,
                                     Material::kConstants,
                                     kTetBlocks,
                                     kBlocks,
                                     Material::constants,
                                     tetEnergy<Material>,
                                     tetGradient<Material>,
                                     tetStiffness<Material, false>,
                                     tetStiffness<Material, true>,
                                     tetState<Material>,
                                     tetRemember<Material>,
                                     &memoryKernels(),
                                     &dilatation};
  return kernels;
}

const TetKernels& pressedKernelsFor(MaterialModel model)
{
  return withLaw(model, [](auto law) -> const TetKernels& {
    return pressedKernelsOf<typename Pressed<decltype(law)>::Type>();
  });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
