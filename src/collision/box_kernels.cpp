#include "box_kernels.h"

namespace soft_tissue
{
namespace kernels_baseline
{
const BoxKernels& boxLoops();
}
namespace kernels_v3
{
const BoxKernels& boxLoops();
}

const BoxKernels& boxKernels(InstructionSet set)
{
  return set == InstructionSet::baseline ? kernels_baseline::boxLoops() : kernels_v3::boxLoops();
}

}  // namespace soft_tissue
