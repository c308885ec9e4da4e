#pragma once

#include <array>

#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/** hessian += block(i, j) for the pairs of some nodes; the block is symmetric in that (j, i) has
 * its transpose. */
template <typename Block>
void addBlocks(int count, const std::array<Index, ContactSample::kMaxNodes>& node,
               BlockMatrix& hessian, const Block& block)
{
  for (int i = 0; i < count; ++i)
  {
    for (int j = 0; j < count; ++j)
    {
      if (node[i] <= node[j])
      {
        hessian.add(node[i], node[j], block(i, j));
      }
    }
  }
}

}  // namespace soft_tissue
