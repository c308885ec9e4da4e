#include "cook_membrane.h"

#include <cmath>
#include <memory>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/nodal_pressure_elasticity.h"
#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/solver/newton.h"
#include "timing.h"

namespace soft_tissue::studies
{
namespace
{
constexpr double kForce = 1e-5;   // so little that all is linear
constexpr double kSprings = 1e5;  // across the plane, beside E = 1
constexpr int kMostTurns = 3;
constexpr double kLongTurn = 500.0;  // ms: no more turns after one
constexpr double kLeft = 0.0, kRight = 48.0, kNear = 1e-9;

/** Springs that hold nodes in their planes of equal z. */
class PlaneSprings : public EnergyTerm
{
 public:
  explicit PlaneSprings(const Points& rest) : rest_(rest) {}

  double value(const Points& x) override
  {
    double squares = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      squares += std::pow(x[i].z() - rest_[i].z(), 2);
    }
    return 0.5 * kSprings * squares;
  }
  void addGradient(const Points& x, Points& gradient) override
  {
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      gradient[i].z() += kSprings * (x[i].z() - rest_[i].z());
    }
  }
  void addHessian(const Points& x, Curvature, BlockMatrix& hessian) override
  {
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      hessian.block(hessian.diagonal(static_cast<Index>(i)))[8] += kSprings;
    }
  }

 private:
  const Points& rest_;
};

/**
 * A uniform force on the right end, by shape functions: a linear triangle's corners have a third of
 * it each, a quadratic one's the middles of the edges. All triangles have the same area.
 */
Points forcesOnTheEnd(const TetMesh& mesh, const QuadraticTetMesh* quadratic, double total)
{
  Points forces((quadratic != nullptr ? quadratic->nodes : mesh.nodes).size(), Vec3::Zero());
  const auto at_end = [&](Index node) { return mesh.nodes[node].x() > kRight - kNear; };
  double shares = 0.0;
  const auto share = [&](Index node) {
    forces[node].y() += 1.0;
    shares += 1.0;
  };
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
  {
    const Tet& tet = mesh.tets[e];
    if (at_end(tet[0]) + at_end(tet[1]) + at_end(tet[2]) + at_end(tet[3]) != 3)
    {
      continue;
    }
    for (int k = 0; k < 4 && quadratic == nullptr; ++k)
    {
      if (at_end(tet[k]))
      {
        share(tet[k]);
      }
    }
    for (int edge = 0; edge < 6 && quadratic != nullptr; ++edge)
    {
      const QuadraticTet& element = quadratic->elements[e];
      if (at_end(element[kTetEdges[edge][0]]) && at_end(element[kTetEdges[edge][1]]))
      {
        share(element[4 + edge]);
      }
    }
  }
  for (Vec3& force : forces)
  {
    force *= total / shares;
  }
  return forces;
}
}  // namespace

FemResult cookMembrane(const FemChoice& choice, int cells, double poisson_ratio)
{
  const double thickness = 32.0 / cells;
  TetMesh mesh = makeBox({cells, cells, 1}, {1.0, 1.0, thickness});
  for (Vec3& p : mesh.nodes)
  {
    p = Vec3(kRight * p.x(), 44.0 * p.x() + p.y() * (44.0 - 28.0 * p.x()), p.z());
  }
  const QuadraticTetMesh with_edges = withEdgeNodes(mesh);
  const QuadraticTetMesh* quadratic = choice.element == ElementKind::tet10 ? &with_edges : nullptr;
  const Points& rest = quadratic != nullptr ? quadratic->nodes : mesh.nodes;
  const auto count = static_cast<Index>(rest.size());
  const std::vector<TetStiffnessParameters> stiffness(mesh.tets.size(), {1.0, poisson_ratio});
  std::unique_ptr<Elasticity> elasticity;
  if (quadratic != nullptr)
  {
    elasticity = std::make_unique<QuadraticTetElasticity>(*quadratic, choice.law, stiffness, 0);
  }
  else if (choice.element == ElementKind::tet4_anp)
  {
    elasticity = std::make_unique<NodalPressureElasticity>(mesh, choice.law, stiffness, 0);
  }
  else
  {
    elasticity = std::make_unique<TetElasticity>(mesh, choice.law, stiffness, 0);
  }
  std::vector<Index> clamped, probe;
  for (Index i = 0; i < count; ++i)
  {
    if (rest[i].x() == kLeft)
    {
      clamped.push_back(i);
    }
    if (std::hypot(rest[i].x() - kRight, rest[i].y() - 52.0) < kNear)
    {
      probe.push_back(i);
    }
  }
  NodalLoads pull(forcesOnTheEnd(mesh, quadratic, kForce * thickness));
  PlaneSprings plane(rest);
  NewtonSolver newton(quadratic != nullptr ? nodeNeighbours(count, quadratic->elements)
                                           : nodeNeighbours(count, mesh.tets),
                      clamped, makeLinearSolver(choice.linear));
  NewtonOptions options;
  options.tolerance = choice.tolerance;
  options.max_iterations = 50;
  const std::vector<EnergyTerm*> terms = {elasticity.get(), &pull, &plane};
  std::vector<double> seconds(terms.size(), 0.0);
  FemResult result;
  Points x;
  std::vector<double> ms;
  for (int turn = 0; turn < kMostTurns && (turn == 0 || ms.back() < kLongTurn); ++turn)
  {
    newton.forgetMatrix();
    x = rest;
    const double start = threadSeconds();
    result.converged = newton.minimise(terms, options, x, seconds).converged;
    ms.push_back(1e3 * (threadSeconds() - start));
  }
  result.ms = median(ms);
  result.tets = mesh.tets.size();
  result.nodes = rest.size();
  for (const Index node : probe)
  {
    result.found += (x[node].y() - rest[node].y()) / (kForce * static_cast<double>(probe.size()));
  }
  return result;
}

}  // namespace soft_tissue::studies
