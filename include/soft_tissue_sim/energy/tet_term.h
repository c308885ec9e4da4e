#pragma once

#include <vector>

#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/energy/tet_chunks.h"
#include "soft_tissue_sim/energy/tet_kernels.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** A sum over the tets of one body, linear or quadratic, whatever the law. */
class TetTerm : public EnergyTerm
{
 public:
  TetTerm(const TetTerm&) = delete;
  TetTerm& operator=(const TetTerm&) = delete;

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  double valueAndGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

 protected:
  /**
   * @param rest        nodes and M tets by their vertices in the rest state
   * @param stencils    M x kernels.nodes, ascending: nodes of each tet as the kernels have them
   * @param first_node  row of the body's node 0 among all positions
   * @throws Error naming a tet whose rest volume isn't positive
   */
  TetTerm(const TetKernels& kernels, const TetMesh& rest, const std::vector<Index>& stencils,
          Index first_node);
  /** The tets of another term under other kernels, all constants zero. */
  TetTerm(const TetKernels& kernels, const TetTerm& tets);

  /** The tet of each lane, or -1; eight lanes a group. */
  const std::vector<Index>& tets() const { return chunks_.tets; }
  Index groupCount() const { return group_count_; }
  const TetKernels& kernels() const { return *kernels_; }
  const TetGroups& groups() const { return groups_; }

  /** See TetGroups. */
  std::vector<double>& constants() { return constants_; }
  const std::vector<double>& volumes() const { return volumes_; }
  void setVolumes(const std::vector<double>& volumes, double factor);
  /** That factor; 1 before. */
  double volumeFactor() const { return volume_factor_; }

  /** Where stress is told, M x kernels.parts x 4: barycentric coordinates by the stencils'
   * vertices. */
  void setPlaces(const std::vector<double>& places);

  /** six[group][point][6][8], see TetKernels::remember. */
  void remember(const Points& x, std::vector<double>& six);

  /** Called before kernels see x, to give them constants that depend on it.
   * @return energy that is of no single tet, J */
  virtual double prepare(const Points&) { return 0.0; }

  /** The node of a lane's corner, as the kernels have it. */
  Index nodeOf(Index lane, int corner) const
  {
    return nodes_[kTetLanes * (kernels_->nodes * (lane / kTetLanes) + corner) + lane % kTetLanes];
  }

  static constexpr Index kGroupGrain = 32;  ///< groups of eight tets per parallel piece

 private:
  void addForces(const Points& x, Points& gradient);
  void addTet(const TetMesh& rest, Index tet, const Index* vertices, std::size_t lane);
  double sumOfEnergies(Index begin, Index end) const;
  void findPositions(const BlockMatrix& hessian);
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
  double volume_factor_ = 1.0;
  TetGroups groups_;
  std::vector<Index> positions_;  ///< blocks of the matrix last seen, see TetKernels::stiffness
  std::size_t matrix_blocks_ = 0;
  std::vector<double> energies_;  ///< per lane
};

}  // namespace soft_tissue
