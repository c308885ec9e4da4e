#include "soft_tissue_sim/energy/tet_kernels.h"

namespace soft_tissue
{
namespace kernels_baseline
{
const TetKernels& kernelsFor(MaterialModel model);
const TetKernels& pressedKernelsFor(MaterialModel model);
const TetKernels& quadraticKernelsFor(MaterialModel model);
}  // namespace kernels_baseline
namespace kernels_v3
{
const TetKernels& kernelsFor(MaterialModel model);
const TetKernels& pressedKernelsFor(MaterialModel model);
const TetKernels& quadraticKernelsFor(MaterialModel model);
}  // namespace kernels_v3
namespace kernels_v4
{
const TetKernels& kernelsFor(MaterialModel model);
const TetKernels& pressedKernelsFor(MaterialModel model);
const TetKernels& quadraticKernelsFor(MaterialModel model);
}  // namespace kernels_v4

const TetKernels& tetKernels(MaterialModel model, InstructionSet set)
{
  switch (set)
  {
    case InstructionSet::x86_64_v4:
      return kernels_v4::kernelsFor(model);
    case InstructionSet::x86_64_v3:
      return kernels_v3::kernelsFor(model);
    default:
      return kernels_baseline::kernelsFor(model);
  }
}

const TetKernels& pressedTetKernels(MaterialModel model, InstructionSet set)
{
  switch (set)
  {
    case InstructionSet::x86_64_v4:
      return kernels_v4::pressedKernelsFor(model);
    case InstructionSet::x86_64_v3:
      return kernels_v3::pressedKernelsFor(model);
    default:
      return kernels_baseline::pressedKernelsFor(model);
  }
}

const TetKernels& quadraticTetKernels(MaterialModel model, InstructionSet set)
{
  switch (set)
  {
    case InstructionSet::x86_64_v4:
      return kernels_v4::quadraticKernelsFor(model);
    case InstructionSet::x86_64_v3:
      return kernels_v3::quadraticKernelsFor(model);
    default:
      return kernels_baseline::quadraticKernelsFor(model);
  }
}

}  // namespace soft_tissue
