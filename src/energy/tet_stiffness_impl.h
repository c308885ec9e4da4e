/**
 * Stiffness of linear tets. Included by kernel files only (see pack.h).
 */
#pragma once

#include "stiffness_blocks.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
template <typename Material, bool kProjected>
void tetStiffness(const TetGroups& groups, Index begin, Index end, const double* x,
                  const Index* positions, double* values)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    constexpr int kSize = 9 * kTetBlocks;
    Pack out[padded(kSize)];
    materialBlocks<Material, kProjected>(t, out);
    for (int k = kSize; k < padded(kSize); ++k)
    {
      out[k] = Pack{};
    }
    addBlocks<kTetBlocks>(out, positions + kTetLanes * kTetBlocks * static_cast<long>(group) + lane,
                          kTetBlocks, values);
  });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
