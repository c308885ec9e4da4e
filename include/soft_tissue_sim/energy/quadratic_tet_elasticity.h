#pragma once

#include "soft_tissue_sim/energy/elasticity.h"
#include "soft_tissue_sim/mesh/quadratic_tets.h"

namespace soft_tissue
{
/**
 * Elastic energy of the quadratic tets of one body: sum of V/4 psi(F) over four Gauss points a tet.
 *
 * Edges are straight at rest, so F is linear in each tet. minDetF() is that of Gauss points and
 * vertices; vonMises() is told in the middle of each of the tets of subdivided().
 */
class QuadraticTetElasticity : public Elasticity
{
 public:
  /**
   * @param rest        N nodes and M elements in the rest state
   * @param parameters  M
   * @param first_node  row of the body's node 0 among all positions
   * @throws Error naming an element whose rest volume isn't positive, or whose nodes are not
   * numbered as QuadraticTetMesh has them
   */
  QuadraticTetElasticity(const QuadraticTetMesh& rest, MaterialModel model,
                         const std::vector<TetStiffnessParameters>& parameters, Index first_node);
};

}  // namespace soft_tissue
