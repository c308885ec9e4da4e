/**
 * The kernels of linear tets, compiled once per instruction set by tet_kernels_*.cpp, which define
 * SOFT_TISSUE_KERNELS (a namespace of their own) and SOFT_TISSUE_LANES (doubles worked on at once,
 * a divisor of 8).
 */
#pragma once

#include "tet_loops.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
const TetKernels& memoryKernels()
{
  static const TetKernels kernels = {4,
                                     1,
                                     1,
                                     StrainMemory::kConstants,
                                     kTetBlocks,
                                     kBlocks,
                                     nullptr,
                                     tetEnergy<StrainMemory>,
                                     tetGradient<StrainMemory>,
                                     tetStiffness<StrainMemory, false>,
                                     tetStiffness<StrainMemory, true>,
                                     nullptr,
                                     tetRemember<StrainMemory>,
                                     nullptr,
                                     nullptr};
  return kernels;
}

template <typename Material>
const TetKernels& kernelsOf()
{
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
                                     nullptr};
  return kernels;
}

const TetKernels& kernelsFor(MaterialModel model)
{
  return withLaw(model, [](auto law) -> const TetKernels& { return kernelsOf<decltype(law)>(); });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
