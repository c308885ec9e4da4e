#pragma once

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/index.h"

namespace soft_tissue
{
/** A block matrix as plain arrays, for kernels. */
struct BlockRows
{
  const Index* offsets;
  const Index* columns;
  const double* values;  ///< 9 per block by columns, and one more readable double at the end
};

/** y = A x for rows begin ... end - 1; x and y are flat, 3 per row. */
using BlockProduct = void (*)(const BlockRows& a, Index begin, Index end, const double* x,
                              double* y);

/** The product for this machine; all give the same bits. */
BlockProduct blockProduct(InstructionSet set);

}  // namespace soft_tissue
