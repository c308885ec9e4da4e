#pragma once

#include <array>
#include <vector>

#include "soft_tissue_sim/energy/deformation_measures.h"
#include "soft_tissue_sim/energy/material.h"
#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/**
 * Energy of a body held together by springs: one along each edge of its tets, and one against the
 * change of each tet's volume.
 *
 * A spring of length l, L at rest, has k/2 (l - L)^2 with k = 1/L^2 times the sum of E_s V over the
 * tets around it; a tet has (lambda - mu)/2 V (J - 1)^2, J being its volume over that at rest V.
 * Source: [VanGelder1998] for k. The mean of the springs over all ways a tet may be turned
 * is the small-strain energy of an isotropic solid with Young's modulus E_s and Poisson's ratio
 * 1/4, where lambda = mu = 0.4 E_s; so E_s = 2.5 mu, and volumes make up for what nu has above 1/4.
 * A mesh has edges in some directions only: single tets are off that mean.
 *
 * Springs below a tenth of their length push back less the shorter they are, so that energy, forces
 * and stiffness are finite and continuous for every shape, points and needles among them.
 */
class MassSpring : public EnergyTerm, public DeformationMeasures
{
 public:
  /**
   * @param rest        N nodes and M tets in the rest state
   * @param parameters  M; Poisson's ratio at least 1/4
   * @param first_node  row of the body's node 0 among all positions
   * @throws Error naming a tet whose rest volume isn't positive or whose parameters are out of
   * range
   */
  MassSpring(const TetMesh& rest, const std::vector<TetStiffnessParameters>& parameters,
             Index first_node);

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  double valueAndGradient(const Points& x, Points& gradient) override;
  /** Positive: each spring's without its negative eigenvalues, volumes' without their curvature. */
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

  double minDetF(const Points& x) override;
  /** Of the stress that a tet's share of its springs has in it: 1/|v| sum of force times edge. */
  void vonMises(const Points& x, std::vector<float>& stress) override;

  std::size_t springCount() const { return springs_.size(); }

 private:
  struct Spring
  {
    std::array<Index, 2> nodes;
    double inverse;  ///< 1 / L^2, 1/m^2
    double work;     ///< k L^2, J
  };
  /** A volume, six times. */
  struct Cell
  {
    std::array<Index, 4> nodes;
    double rest;  ///< m^3
    double bulk;  ///< energy over half the square of its change, J/m^6
  };
  /** Elements in the order they are worked on: as in TetChunks. */
  struct Order
  {
    std::vector<Index> chunks, colours;
    template <typename Body>
    void forChunks(const Body& body) const;
  };
  template <typename Element>
  static Order sortElements(const Points& rest, Index first_node, std::vector<Element>& elements);

  void findPositions(const BlockMatrix& hessian);
  void addSpring(const Points& x, std::size_t spring, bool positive, BlockMatrix& hessian) const;
  void addVolume(const Points& x, std::size_t cell, bool positive, BlockMatrix& hessian) const;

  std::vector<Cell> tets_;                              ///< all, in the mesh's order
  std::vector<double> moduli_;                          ///< E_s of each, Pa
  std::vector<std::array<double, 6>> inverse_lengths_;  ///< 1 / L^2 of its edges
  std::vector<Spring> springs_;
  std::vector<Cell> cells_;  ///< tets that resist to a change of volume
  Order spring_order_, cell_order_;
  std::vector<Index> positions_;  ///< in the matrix last seen: 3 a spring, then 10 a cell
  std::size_t matrix_blocks_ = 0;
};

}  // namespace soft_tissue
