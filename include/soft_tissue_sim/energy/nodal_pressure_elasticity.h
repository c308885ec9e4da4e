#pragma once

#include "soft_tissue_sim/energy/elasticity.h"

namespace soft_tissue
{
/**
 * Elastic energy of the linear tets of one body whose resistance to changes of volume is that of
 * nodes: they do not lock as Poisson's ratio goes to 0.5.
 *
 * Every law is psi_0(F) + lambda U(d(F)) with the dilatation d: det F, or the trace of the law's
 * strain. Here the second part takes, in place of each tet's d, the mean d_n over the tets of a
 * node, weighted by volume:
 *
 *   sum of V psi_0(F)  +  sum over nodes n of V_n lambda U(d_n),    V_n a quarter of their volumes
 *
 * so a tet's pressure is the mean of those of its nodes. Uniform strain has the energy it has in
 * TetElasticity. At a node where tets of different stiffness meet, each kind has a mean of its own.
 * Negative lambda stays with the tets. Source: [Bonet1998], [Joldes2009]
 */
class NodalPressureElasticity : public Elasticity
{
 public:
  /** As TetElasticity has them. @throws Error naming a tet whose rest volume isn't positive */
  NodalPressureElasticity(const TetMesh& rest, MaterialModel model,
                          const std::vector<TetStiffnessParameters>& parameters, Index first_node);

  /** See EnergyTerm: what means add are outer products. */
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

 protected:
  double prepare(const Points& x) override;

 private:
  void findMeans(const std::vector<TetStiffnessParameters>& parameters);
  void findNodes();
  void takeMeans(const Points& x);
  void givePressures();

  // A mean is that of the tets of one stiffness at one node; a corner is 4 lane + its place among a
  // tet's nodes.
  Index mean_count_ = 0;
  Adjacency corners_;           ///< per mean
  Adjacency nodes_;             ///< per mean: all nodes of its tets, rows of x
  std::vector<Index> mean_of_;  ///< per corner; mean_count_ for none
  std::vector<int> slots_;      ///< per item of corners_: places of its tet's 4 nodes in nodes_
  std::vector<double> rest_volumes_;  ///< per lane, m^3
  std::vector<double> mean_volumes_;  ///< V_n, m^3
  std::vector<double> mean_lambdas_;  ///< Pa, > 0
  std::vector<double> dilatations_;   ///< per lane
  std::vector<double> gradients_;     ///< see DilatationKernels
  // Per mean, filled up to whole groups of lanes, and one place of zeros more:
  std::vector<double> means_, energies_, slopes_, curvatures_;  ///< d_n; U and its derivatives
};

}  // namespace soft_tissue
