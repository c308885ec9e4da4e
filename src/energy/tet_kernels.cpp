#include "soft_tissue_sim/energy/tet_kernels.h"

namespace soft_tissue
{
namespace kernels_baseline
{
const TetKernels& kernelsFor(MaterialModel model);
}
namespace kernels_v3
{
const TetKernels& kernelsFor(MaterialModel model);
}
namespace kernels_v4
{
const TetKernels& kernelsFor(MaterialModel model);
}

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

}  // namespace soft_tissue
