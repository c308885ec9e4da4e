#include "soft_tissue_sim/collision/clip_pairs.h"

#include "soft_tissue_sim/collision/clip_kernels.h"

namespace soft_tissue
{
namespace kernels_baseline
{
ClipPairs clipLoop();
}
namespace kernels_v3
{
ClipPairs clipLoop();
}

ClipPairs clipKernel(InstructionSet set)
{
  return set == InstructionSet::baseline ? kernels_baseline::clipLoop() : kernels_v3::clipLoop();
}

void clipPairs(const ElementSet& segments, const Vec3* x_segments, const ElementSet& tets,
               const Vec3* x_tets, const std::vector<ElementPair>& pairs,
               std::vector<ClippedPair>& pieces)
{
  pieces.resize(pairs.size());
  pieces.resize(clipKernel(instructionSet())(segments, x_segments, tets, x_tets, pairs.data(),
                                             static_cast<Index>(pairs.size()), pieces.data()));
}

}  // namespace soft_tissue
