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
  forLanes<Material>(groups, begin, end, x, [&](Index group, int lane, const Lanes<Material>& t) {
    constexpr int kSize = 9 * kTetBlocks;
    Pack out[padded(kSize)];
    materialBlocks<Material, kProjected>(t, out);
    for (int k = kSize; k < padded(kSize); ++k)
    {
      out[k] = Pack{};
    }
    alignas(64) double rows[kLanes][padded(kSize)];
    transpose<kSize>(out, rows);
    addBlocks<kTetBlocks>(
        rows, positions + kTetLanes * kTetBlocks * static_cast<long>(group) + lane, values);
  });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
