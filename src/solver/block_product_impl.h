/** y = A x over block rows; compiled once per instruction set into SOFT_TISSUE_KERNELS. */
#pragma once

#include <cstring>

#include "soft_tissue_sim/solver/block_product.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
typedef double Four __attribute__((vector_size(32)));

inline Four loadFour(const double* p)
{
  Four v;
  std::memcpy(&v, p, sizeof(Four));
  return v;
}

void multiplyBlocks(const BlockRows& a, Index begin, Index end, const double* x, double* y)
{
  for (Index row = begin; row < end; ++row)
  {
    // One running sum per column of the blocks; the fourth lane carries what the wide loads bring
    // along.
    Four sum0 = {}, sum1 = {}, sum2 = {};
    const double* block = a.values + 9 * static_cast<long>(a.offsets[row]);
    for (Index k = a.offsets[row]; k < a.offsets[row + 1]; ++k, block += 9)
    {
      const double* v = x + 3 * static_cast<long>(a.columns[k]);
      sum0 += loadFour(block) * v[0];
      sum1 += loadFour(block + 3) * v[1];
      sum2 += loadFour(block + 6) * v[2];
    }
    const Four sum = (sum0 + sum1) + sum2;
    y[3 * static_cast<long>(row) + 0] = sum[0];
    y[3 * static_cast<long>(row) + 1] = sum[1];
    y[3 * static_cast<long>(row) + 2] = sum[2];
  }
}

BlockProduct product()
{
  return multiplyBlocks;
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
