#pragma once

#include <vector>

#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/energy/tet_kernels.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** Stiffness of one tet. */
struct TetStiffnessParameters
{
  double young_modulus = 0.0;  ///< Pa, > 0
  double poisson_ratio = 0.0;  ///< in (-1, 0.5)
};

/** Elastic energy of the linear tets of one body: sum of V psi(F). */
class TetElasticity : public EnergyTerm
{
 public:
  /**
   * @param rest        N nodes and M tets in the rest state
   * @param parameters  M
   * @param first_node  row of the body's node 0 among all positions
   * @throws Error naming the first tet whose rest volume isn't positive
   */
  TetElasticity(const TetMesh& rest, MaterialModel model,
                const std::vector<TetStiffnessParameters>& parameters, Index first_node);

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

  /** Smallest det F over all tets: 1 at rest, <= 0 when one is inverted. */
  double minDetF(const Points& x);

  /** Equivalent (von Mises) Cauchy stress per tet, M, Pa. */
  void vonMises(const Points& x, std::vector<float>& stress);

 private:
  struct BlockSource
  {
    Index place;      ///< in stiffness_
    bool transposed;  ///< the tet stores the block the other way round
  };
  void prepareGathers(const TetMesh& rest);
  void prepareBlocks(const BlockMatrix& hessian);
  void state(const Points& x, double* von_mises);

  Index first_node_;
  Index node_count_;
  Index tet_count_;
  Index group_count_;
  const TetKernels* kernels_;
  std::vector<Tet> tets_;

  std::vector<Index> group_nodes_;
  std::vector<double> group_gradients_;
  std::vector<double> group_volumes_;
  std::vector<double> group_constants_;
  TetGroups groups_;

  std::vector<double> energies_;   ///< per lane
  std::vector<double> det_f_;      ///< per lane
  std::vector<double> von_mises_;  ///< per lane; empty until asked for
  std::vector<double> gradients_;  ///< 12 per tet
  std::vector<double> stiffness_;  ///< kTetStiffnessSize per tet

  Adjacency corners_;  ///< per node: places in gradients_, over 3

  // Where the matrix's blocks on and above the diagonal come from; made for the first matrix seen.
  std::vector<Index> block_position_;       ///< matrix block (row <= column)
  std::vector<Index> block_mirror_;         ///< its transpose's
  std::vector<Index> block_sources_begin_;  ///< ranges in block_sources_
  std::vector<BlockSource> block_sources_;
  std::size_t matrix_blocks_ = 0;
};

}  // namespace soft_tissue
