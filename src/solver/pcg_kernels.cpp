#include "soft_tissue_sim/solver/pcg_kernels.h"

namespace soft_tissue
{
namespace kernels_baseline
{
template <typename Real>
const PcgKernels<Real>& pcgLoops();
}
namespace kernels_v3
{
template <typename Real>
const PcgKernels<Real>& pcgLoops();
}

template <typename Real>
const PcgKernels<Real>& pcgKernels(InstructionSet set)
{
  // Four numbers suit a 3 x 3 block: wider registers than those of v3 would not help.
  return set == InstructionSet::baseline ? kernels_baseline::pcgLoops<Real>()
                                         : kernels_v3::pcgLoops<Real>();
}

template const PcgKernels<float>& pcgKernels<float>(InstructionSet);
template const PcgKernels<double>& pcgKernels<double>(InstructionSet);

}  // namespace soft_tissue
