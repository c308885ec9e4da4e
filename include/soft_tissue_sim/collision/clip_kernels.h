#pragma once

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/collision/clip_pairs.h"

namespace soft_tissue
{
/** See clipPairs(); `pieces` has room for all. All sets of instructions give the same bits.
 * @return how many there are */
using ClipPairs = Index (*)(const ElementSet& segments, const Vec3* x_segments,
                            const ElementSet& tets, const Vec3* x_tets, const ElementPair* pairs,
                            Index count, ClippedPair* pieces);

/** The one for this machine. */
ClipPairs clipKernel(InstructionSet set);

}  // namespace soft_tissue
