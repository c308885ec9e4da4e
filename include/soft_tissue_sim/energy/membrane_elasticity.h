#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
struct MembraneParts;

/** Stiffness of one triangle of a membrane. */
struct MembraneParameters
{
  double young_modulus = 0.0;  ///< Pa, > 0
  double poisson_ratio = 0.0;  ///< in (-1, 0.5]
  double thickness = 0.0;      ///< m, > 0
};

/**
 * Nodes that a membrane couples: those of each triangle and of the three beside it, all with all.
 * An edge of one, or of three and more triangles has none beside it.
 */
Adjacency membraneNeighbours(Index node_count, const std::vector<Triangle>& triangles);

/**
 * Elastic energy of the triangles of one body, stress-free in their rest shape, flat or curved:
 * stretching in their planes plus bending between them.
 *
 * Stretching, per rest area, with singular values s of the 3 x 2 deformation gradient, J = s1 s2:
 *   thickness (mu/2 (s1 - s2)^2 + kappa/2 (j - 1)^2 + mu (J - j)),  kappa = E / (2 (1 - nu)),
 * where j = J but below J = 0.1, where it goes over into a polynomial in J^2. Small strains are
 * those of Hooke's plane stress; forces and their derivatives are finite for every shape.
 *
 * Bending: 1/2 a^T W a per triangle, a being how far the angles at its edges are from those at
 * rest. W is fitted to the rest mesh such that every constant curvature meets the moments of a
 * Kirchhoff plate of D = E t^3 / (12 (1 - nu^2)) as nearly as a positive W can; plates were found
 * to converge on meshes of every texture tried (docs/accuracy.md). Its ratio of lateral contraction
 * is -|nu|: edges held or clamped don't see that, nor do strips that bend; but a strip with free
 * edges resists torsion by (1 + nu) / (1 - nu) too much. Edges of one triangle, or of more than
 * two, don't bend. The angle at an edge is in (-pi, pi]: further folding would go through itself.
 * Triangles below a tenth of their rest area gradually cease to bend.
 */
class MembraneElasticity : public EnergyTerm
{
 public:
  /**
   * @param rest        N nodes and M triangles in the rest state; their winding may differ
   * @param parameters  M
   * @param first_node  row of the body's node 0 among all positions
   * @throws Error naming a triangle whose rest area isn't positive or whose parameters are out of
   *         range
   */
  MembraneElasticity(const TriMesh& rest, const std::vector<MembraneParameters>& parameters,
                     Index first_node);

  ~MembraneElasticity() override;

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  double valueAndGradient(const Points& x, Points& gradient) override;
  /** Positive: stretching without its negative eigenvalues, bending without the curvature of the
   * angles. */
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

  /** Smallest deformed area over rest area of all triangles: 1 at rest, 0 when one has collapsed.
   */
  double smallestAreaRatio(const Points& x) const;

 private:
  std::unique_ptr<MembraneParts> parts_;
};

}  // namespace soft_tissue
