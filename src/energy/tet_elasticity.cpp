#include "soft_tissue_sim/energy/tet_elasticity.h"

#include "tet_nodes.h"

namespace soft_tissue
{
TetElasticity::TetElasticity(const TetMesh& rest, MaterialModel model,
                             const std::vector<TetStiffnessParameters>& parameters,
                             Index first_node)
    : Elasticity(tetKernels(model, instructionSet()), rest, ascendingNodes(rest.tets), parameters,
                 first_node)
{}

}  // namespace soft_tissue
