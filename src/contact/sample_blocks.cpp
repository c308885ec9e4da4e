#include "sample_blocks.h"

#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
void addBlock(BlockMatrix& hessian, Index row, Index column, const Mat3& b)
{
  const Index position = hessian.find(row, column);
  if (position < 0)
  {
    throw Error("contact couples nodes " + std::to_string(row) + " and " + std::to_string(column) +
                ", which share no element of the matrix's pattern");
  }
  double* block = hessian.block(position);
  for (int i = 0; i < 9; ++i)
  {
    block[i] += b.data()[i];
  }
}

}  // namespace soft_tissue
