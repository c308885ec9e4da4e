#pragma once

#include <vector>

#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/energy/tet_chunks.h"
#include "soft_tissue_sim/energy/tet_kernels.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** Elastic energy of the tets of one body: what linear and quadratic ones have in common. */
class Elasticity : public EnergyTerm
{
 public:
  Elasticity(const Elasticity&) = delete;
  Elasticity& operator=(const Elasticity&) = delete;

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  double valueAndGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

  /** Smallest det F of all tets: 1 at rest, <= 0 when one is inverted. */
  double minDetF(const Points& x);

  /** Equivalent (von Mises) Cauchy stress, Pa: one per linear tet, one per part of a quadratic
   * one. */
  void vonMises(const Points& x, std::vector<float>& stress);

 protected:
  /**
   * @param rest        nodes and M tets by their vertices in the rest state
   * @param stencils    M x kernels.nodes, ascending: nodes of each tet as the kernels have them
   * @param parameters  M
   * @param first_node  row of the body's node 0 among all positions
   * @throws Error naming a tet whose rest volume isn't positive
   */
  Elasticity(const TetKernels& kernels, const TetMesh& rest, const std::vector<Index>& stencils,
             const std::vector<TetStiffnessParameters>& parameters, Index first_node);

  /** Where stress is told, M x kernels.parts x 4: barycentric coordinates by the stencils'
   * vertices. */
  void setPlaces(const std::vector<double>& places);

 private:
  void addTet(const TetMesh& rest, Index tet, const Index* vertices, std::size_t lane,
              const TetStiffnessParameters& parameters);
  double sumOfEnergies(Index begin, Index end) const;
  void findPositions(const BlockMatrix& hessian);
  void state(const Points& x, double* von_mises);
  /** Calls body(begin, end) for ranges of groups, at once only for those that share no node. */
  template <typename Body>
  void forGroups(const Body& body) const;

  const TetKernels* kernels_;
  TetChunks chunks_;
  Index group_count_;

  // Arrays over groups of lanes, see TetGroups.
  std::vector<Index> nodes_;
  std::vector<double> rest_gradients_;
  std::vector<double> volumes_;
  std::vector<double> constants_;
  std::vector<double> places_;
  TetGroups groups_;
  std::vector<Index> positions_;  ///< blocks of the matrix last seen, see TetKernels::stiffness
  std::size_t matrix_blocks_ = 0;

  std::vector<double> energies_;   ///< per lane
  std::vector<double> det_f_;      ///< per lane
  std::vector<double> von_mises_;  ///< [group][part][lane]; empty until asked for
};

}  // namespace soft_tissue
