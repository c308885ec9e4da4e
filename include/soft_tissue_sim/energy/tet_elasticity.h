#pragma once

#include "soft_tissue_sim/energy/elasticity.h"

namespace soft_tissue
{
/** Elastic energy of the linear tets of one body: sum of V psi(F). */
class TetElasticity : public Elasticity
{
 public:
  /**
   * @param rest        N nodes and M tets in the rest state
   * @param parameters  M
   * @param first_node  row of the body's node 0 among all positions
   * @throws Error naming a tet whose rest volume isn't positive
   */
  TetElasticity(const TetMesh& rest, MaterialModel model,
                const std::vector<TetStiffnessParameters>& parameters, Index first_node);
};

}  // namespace soft_tissue
