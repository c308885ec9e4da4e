#include "soft_tissue_sim/solver/block_product.h"

namespace soft_tissue
{
namespace kernels_baseline
{
BlockProduct product();
}
namespace kernels_v3
{
BlockProduct product();
}

BlockProduct blockProduct(InstructionSet set)
{
  // Four doubles suit a 3 x 3 block: wider registers would not help.
  return set == InstructionSet::baseline ? kernels_baseline::product() : kernels_v3::product();
}

}  // namespace soft_tissue
