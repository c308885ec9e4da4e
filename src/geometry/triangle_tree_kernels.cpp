#include "soft_tissue_sim/geometry/triangle_tree_kernels.h"

namespace soft_tissue
{
namespace kernels_baseline
{
SearchTriangleTree treeSearch();
}
namespace kernels_v3
{
SearchTriangleTree treeSearch();
}

SearchTriangleTree searchTriangleTree(InstructionSet set)
{
  return set == InstructionSet::baseline ? kernels_baseline::treeSearch()
                                         : kernels_v3::treeSearch();
}

}  // namespace soft_tissue
