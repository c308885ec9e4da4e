#include "soft_tissue_sim/energy/tet_elasticity.h"

#include <algorithm>

namespace soft_tissue
{
namespace
{
/** The nodes of each tet by number: F is that of any order, and blocks are then above the diagonal.
 */
std::vector<Index> ascendingNodes(const std::vector<Tet>& tets)
{
  std::vector<Index> nodes;
  nodes.reserve(4 * tets.size());
  for (Tet tet : tets)
  {
    std::sort(tet.begin(), tet.end());
    nodes.insert(nodes.end(), tet.begin(), tet.end());
  }
  return nodes;
}
}  // namespace

TetElasticity::TetElasticity(const TetMesh& rest, MaterialModel model,
                             const std::vector<TetStiffnessParameters>& parameters,
                             Index first_node)
    : Elasticity(tetKernels(model, instructionSet()), rest, ascendingNodes(rest.tets), parameters,
                 first_node)
{}

}  // namespace soft_tissue
