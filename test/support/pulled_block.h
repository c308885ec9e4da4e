#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/solver/newton.h"

namespace soft_tissue::test
{
using Terms = std::vector<EnergyTerm*>;

inline NewtonOptions optionsOf(double tolerance, int max_iterations)
{
  NewtonOptions options;
  options.tolerance = tolerance;
  options.max_iterations = max_iterations;
  return options;
}

inline NewtonReport minimise(NewtonSolver& newton, const Terms& terms, const NewtonOptions& options,
                             Points& x)
{
  std::vector<double> seconds(terms.size(), 0.0);
  newton.forgetMatrix();
  return newton.minimise(terms, options, x, seconds);
}

/** A block of soft material fixed at its bottom and pulled at its top. */
struct PulledBlock
{
  TetMesh mesh = makeBox({4, 3, 5}, {0.04, 0.03, 0.05});
  std::vector<Index> fixed;
  TetElasticity elasticity;
  NodalLoads loads;
  Terms terms = {&elasticity, &loads};

  explicit PulledBlock(const Vec3& pull, double poisson_ratio = 0.4)
      : elasticity(mesh, MaterialModel::neo_hookean, {mesh.tets.size(), {5000.0, poisson_ratio}},
                   0),
        loads(forces(mesh, pull))
  {
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    {
      if (mesh.nodes[i].z() == 0.0)
      {
        fixed.push_back(static_cast<Index>(i));
      }
    }
  }

  NewtonSolver newton(std::unique_ptr<LinearSolver> linear) const
  {
    return NewtonSolver(nodeNeighbours(static_cast<Index>(mesh.nodes.size()), mesh.tets), fixed,
                        std::move(linear));
  }

 private:
  static Points forces(const TetMesh& mesh, const Vec3& pull)
  {
    Points all;
    for (const Vec3& p : mesh.nodes)
    {
      all.push_back(p.z() > 0.0499 ? Vec3(pull / 20.0) : Vec3(Vec3::Zero()));
    }
    return all;
  }
};

constexpr double kPull = 0.6;  // N on 12 cm^2 of 5 kPa: a strain of about a tenth

}  // namespace soft_tissue::test
