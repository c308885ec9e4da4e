#include "soft_tissue_sim/geometry/meeting_kernels.h"

namespace soft_tissue
{
namespace kernels_baseline
{
const MeetingKernels& meetings();
}
namespace kernels_v3
{
const MeetingKernels& meetings();
}

const MeetingKernels& meetingKernels(InstructionSet set)
{
  return set == InstructionSet::baseline ? kernels_baseline::meetings() : kernels_v3::meetings();
}

}  // namespace soft_tissue
