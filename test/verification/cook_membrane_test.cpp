#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/nodal_pressure_elasticity.h"
#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/scene/config.h"
#include "soft_tissue_sim/solver/newton.h"

namespace soft_tissue
{
namespace
{
/** Holds all nodes in their plane of equal z, by springs. */
class PlaneStrain : public EnergyTerm
{
 public:
  PlaneStrain(const Points& rest, double stiffness) : rest_(rest), stiffness_(stiffness) {}

  double value(const Points& x) override
  {
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      sum += 0.5 * stiffness_ * std::pow(x[i].z() - rest_[i].z(), 2);
    }
    return sum;
  }
  void addGradient(const Points& x, Points& gradient) override
  {
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      gradient[i].z() += stiffness_ * (x[i].z() - rest_[i].z());
    }
  }
  void addHessian(const Points& x, Curvature, BlockMatrix& hessian) override
  {
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      hessian.block(hessian.diagonal(static_cast<Index>(i)))[8] += stiffness_;
    }
  }

 private:
  const Points& rest_;
  double stiffness_;
};

constexpr double kForce = 1e-5;  // so little that all is linear

/**
 * Cook's membrane: (0, 0) (48, 44) (48, 60) (0, 44), clamped at x = 0, a shear force of kForce per
 * thickness spread over x = 48, E = 1, in plane strain: cells x cells in one layer.
 * @return the way of (48, 52) up, per unit force
 */
double cookDeflection(ElementKind kind, int cells, double poisson_ratio)
{
  const double thickness = 32.0 / cells;
  TetMesh box = makeBox({cells, cells, 1}, {1.0, 1.0, thickness});
  for (Vec3& p : box.nodes)
  {
    p = Vec3(48.0 * p.x(), 44.0 * p.x() + p.y() * (44.0 - 28.0 * p.x()), p.z());
  }
  const QuadraticTetMesh quadratic = withEdgeNodes(box);
  const bool is_quadratic = kind == ElementKind::tet10;
  const Points& rest = is_quadratic ? quadratic.nodes : box.nodes;
  const auto count = static_cast<Index>(rest.size());
  const std::vector<TetStiffnessParameters> stiffness(box.tets.size(), {1.0, poisson_ratio});
  std::unique_ptr<Elasticity> elasticity;
  Adjacency neighbours;
  if (is_quadratic)
  {
    elasticity = std::make_unique<QuadraticTetElasticity>(quadratic, MaterialModel::neo_hookean,
                                                          stiffness, 0);
    neighbours = nodeNeighbours(count, quadratic.elements);
  }
  else
  {
    neighbours = nodeNeighbours(count, box.tets);
  }
  if (kind == ElementKind::tet4)
  {
    elasticity = std::make_unique<TetElasticity>(box, MaterialModel::neo_hookean, stiffness, 0);
  }
  else if (kind == ElementKind::tet4_anp)
  {
    elasticity =
        std::make_unique<NodalPressureElasticity>(box, MaterialModel::neo_hookean, stiffness, 0);
  }
  std::vector<Index> clamped;
  Points forces(rest.size(), Vec3::Zero());
  double weights = 0.0;
  for (Index i = 0; i < count; ++i)
  {
    if (rest[i].x() == 0.0)
    {
      clamped.push_back(i);
    }
  }
  // What the shape functions of each triangle of the end have of a uniform force.
  const auto load = [&](Index node, double share) {
    forces[node].y() += share;
    weights += share;
  };
  for (std::size_t e = 0; e < box.tets.size(); ++e)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      std::vector<Index> face, middles;
      for (int k = 0; k < 4; ++k)
      {
        if (k != corner && rest[box.tets[e][k]].x() > 48.0 - 1e-9)
        {
          face.push_back(box.tets[e][k]);
        }
      }
      for (int edge = 0; edge < 6; ++edge)
      {
        if (kTetEdges[edge][0] != corner && kTetEdges[edge][1] != corner)
        {
          middles.push_back(quadratic.elements[e][4 + edge]);
        }
      }
      if (face.size() == 3)
      {
        for (const Index node : is_quadratic ? middles : face)
        {
          load(node, 1.0);  // all triangles of the end have the same area
        }
      }
    }
  }
  for (Vec3& force : forces)
  {
    force *= kForce * thickness / weights;
  }
  NodalLoads pull(forces);
  PlaneStrain plane(rest, 1e5);
  NewtonSolver newton(neighbours, clamped, makeCholesky());
  NewtonOptions options;
  options.tolerance = 1e-7;
  options.max_iterations = 50;
  std::vector<EnergyTerm*> terms = {elasticity.get(), &pull, &plane};
  std::vector<double> seconds(terms.size(), 0.0);
  Points x = rest;
  EXPECT_TRUE(newton.minimise(terms, options, x, seconds).converged);
  double sum = 0.0;
  int nodes = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    if ((rest[i].head<2>() - Vec3(48.0, 52.0, 0.0).head<2>()).norm() < 1e-9)
    {
      sum += x[i].y() - rest[i].y();
      ++nodes;
    }
  }
  EXPECT_GT(nodes, 0);
  return sum / nodes / kForce;
}

struct Published
{
  double poisson_ratio;
  double deflection;
  double most;  ///< error of 16 cells a side of quadratic tets
};

/** Orders at which three meshes, each half as coarse as the last, go to a known value. */
std::array<double, 2> ordersOf(const std::array<double, 3>& errors)
{
  return {std::log2(errors[0] / errors[1]), std::log2(errors[1] / errors[2])};
}

// Published in plane strain. Linear tets lock as nu goes to 0.5; quadratic ones get slower only.
TEST(CookMembrane, BendsAndShearsAsItShouldWithQuadraticTets)
{
  for (const Published& row : {Published{1.0 / 3.0, 21.522, 0.005}, Published{0.45, 19.574, 0.01},
                               Published{0.49, 18.718, 0.015}, Published{0.4999, 18.483, 0.03}})
  {
    const auto errorOf = [&](ElementKind kind, int cells) {
      const double found = cookDeflection(kind, cells, row.poisson_ratio);
      const double error = found / row.deflection - 1.0;
      std::printf("  nu %.4f, tet%s, %d cells: %.3f, %+.2f %%\n", row.poisson_ratio,
                  kind == ElementKind::tet4 ? "4" : "10", cells, found, 100.0 * error);
      return error;
    };
    const auto three = [&](ElementKind kind, int coarsest) {
      const std::array<double, 3> errors = {errorOf(kind, coarsest), errorOf(kind, 2 * coarsest),
                                            errorOf(kind, 4 * coarsest)};
      const std::array<double, 2> orders = ordersOf(errors);
      std::printf("    orders %.2f %.2f\n", orders[0], orders[1]);
      EXPECT_LT(errors[0], errors[1]);
      EXPECT_LT(errors[1], errors[2]);
      EXPECT_GT(orders[0], kind == ElementKind::tet4 ? 0.0 : 1.2);
      return errors;
    };
    const std::array<double, 3> linear = three(ElementKind::tet4, 8);
    const std::array<double, 3> quadratic = three(ElementKind::tet10, 4);
    EXPECT_LT(std::abs(quadratic[2]), row.most);
    EXPECT_GT(std::abs(linear[1]), 20.0 * std::abs(quadratic[2]));  // as many nodes
  }
}

// Average nodal pressures keep linear tets from locking, and cost accuracy nowhere.
TEST(CookMembrane, DoesNotLockWithAverageNodalPressure)
{
  for (const Published& row : {Published{1.0 / 3.0, 21.522, 0.03}, Published{0.45, 19.574, 0.03},
                               Published{0.49, 18.718, 0.04}, Published{0.4999, 18.483, 0.05}})
  {
    const auto errorOf = [&](ElementKind kind, int cells) {
      const double found = cookDeflection(kind, cells, row.poisson_ratio);
      const double error = found / row.deflection - 1.0;
      std::printf("  nu %.4f, %s, %d cells: %.3f, %+.2f %%\n", row.poisson_ratio,
                  kind == ElementKind::tet4 ? "tet4" : "tet4_anp", cells, found, 100.0 * error);
      return error;
    };
    const std::array<double, 3> errors = {errorOf(ElementKind::tet4_anp, 8),
                                          errorOf(ElementKind::tet4_anp, 16),
                                          errorOf(ElementKind::tet4_anp, 32)};
    const std::array<double, 2> orders = ordersOf(errors);
    std::printf("    orders %.2f %.2f\n", orders[0], orders[1]);
    EXPECT_LT(errors[0], errors[1]);
    EXPECT_GT(orders[1], 1.3);
    EXPECT_LT(std::abs(errors[2]), row.most);
    EXPECT_GT(errors[2], errorOf(ElementKind::tet4, 32));
    if (row.poisson_ratio > 0.4995)
    {
      EXPECT_LT(std::abs(errorOf(ElementKind::tet4_anp, 64)), 0.02);
      EXPECT_LT(errorOf(ElementKind::tet4, 64), -0.2);
    }
  }
}

}  // namespace
}  // namespace soft_tissue
