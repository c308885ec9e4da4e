#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/nodal_pressure_elasticity.h"
#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "soft_tissue_sim/scene/config.h"
#include "soft_tissue_sim/solver/newton.h"

namespace soft_tissue
{
namespace
{
constexpr double kYoung = 1e4;   // Pa
constexpr double kSmall = 1e-5;  // of a load, so that all is linear
constexpr double kHold = 1e6;    // N/m, stiffness of the planes nodes slide on

/** Holds nodes on planes, by stiff springs along the normals. */
class Sliding : public EnergyTerm
{
 public:
  void hold(Index node, const Vec3& normal, const Vec3& point)
  {
    held_.push_back({node, normal.normalized(), point});
  }

  double value(const Points& x) override
  {
    double sum = 0.0;
    for (const Held& held : held_)
    {
      sum += 0.5 * kHold * std::pow(held.normal.dot(x[held.node] - held.point), 2);
    }
    return sum;
  }
  void addGradient(const Points& x, Points& gradient) override
  {
    for (const Held& held : held_)
    {
      gradient[held.node] += kHold * held.normal.dot(x[held.node] - held.point) * held.normal;
    }
  }
  void addHessian(const Points&, Curvature, BlockMatrix& hessian) override
  {
    for (const Held& held : held_)
    {
      hessian.add(held.node, held.node, kHold * held.normal * held.normal.transpose());
    }
  }

 private:
  struct Held
  {
    Index node;
    Vec3 normal, point;
  };
  std::vector<Held> held_;
};

/** A body of any element, linear. */
struct Body
{
  Body(const TetMesh& mesh, ElementKind kind, double poisson_ratio)
      : tets(mesh), quadratic(withEdgeNodes(mesh)), is_quadratic(kind == ElementKind::tet10)
  {
    const std::vector<TetStiffnessParameters> stiffness(mesh.tets.size(), {kYoung, poisson_ratio});
    const auto count = static_cast<Index>(rest().size());
    if (is_quadratic)
    {
      elasticity = std::make_unique<QuadraticTetElasticity>(quadratic, MaterialModel::neo_hookean,
                                                            stiffness, 0);
      neighbours = nodeNeighbours(count, quadratic.elements);
    }
    else
    {
      neighbours = nodeNeighbours(count, mesh.tets);
    }
    if (kind == ElementKind::tet4)
    {
      elasticity = std::make_unique<TetElasticity>(mesh, MaterialModel::neo_hookean, stiffness, 0);
    }
    else if (kind == ElementKind::tet4_anp)
    {
      elasticity =
          std::make_unique<NodalPressureElasticity>(mesh, MaterialModel::neo_hookean, stiffness, 0);
    }
    forces.assign(rest().size(), Vec3::Zero());
  }

  const Points& rest() const { return is_quadratic ? quadratic.nodes : tets.nodes; }

  /** Presses on the faces whose corners all satisfy a condition, as their shape functions say. */
  template <typename Condition>
  void press(double pressure, const Condition& on)
  {
    for (std::size_t e = 0; e < tets.tets.size(); ++e)
    {
      for (int corner = 0; corner < 4; ++corner)
      {
        std::vector<Index> face, middles;
        for (int k = 0; k < 4; ++k)
        {
          if (k != corner && on(tets.nodes[tets.tets[e][k]]))
          {
            face.push_back(tets.tets[e][k]);
          }
        }
        if (face.size() < 3)
        {
          continue;
        }
        for (int edge = 0; edge < 6; ++edge)
        {
          if (kTetEdges[edge][0] != corner && kTetEdges[edge][1] != corner)
          {
            middles.push_back(quadratic.elements[e][4 + edge]);
          }
        }
        const Vec3& a = tets.nodes[face[0]];
        Vec3 area = 0.5 * (tets.nodes[face[1]] - a).cross(tets.nodes[face[2]] - a);
        if (area.dot(tets.nodes[tets.tets[e][corner]] - a) < 0.0)
        {
          area = -area;  // into the body
        }
        for (const Index node : is_quadratic ? middles : face)
        {
          forces[node] += pressure / 3.0 * area;
        }
      }
    }
  }

  Points solve()
  {
    NodalLoads load(forces);
    NewtonSolver newton(neighbours, {}, makeCholesky());
    NewtonOptions options;
    options.tolerance = 1e-7;
    std::vector<EnergyTerm*> terms = {elasticity.get(), &load, &sliding};
    std::vector<double> seconds(terms.size(), 0.0);
    Points x = rest();
    EXPECT_TRUE(newton.minimise(terms, options, x, seconds).converged);
    return x;
  }

  TetMesh tets;
  QuadraticTetMesh quadratic;
  bool is_quadratic;
  Adjacency neighbours;
  std::unique_ptr<Elasticity> elasticity;
  Sliding sliding;
  Points forces;
};

// --- Lame: thick shells under internal pressure
// ---------------------------------------------------
constexpr double kInner = 0.01, kOuter = 0.02;  // m
constexpr double kPressure = 1e3;               // Pa

struct Lame
{
  bool sphere;
  double poisson_ratio, inner, outer;  ///< m, how far both surfaces go
};

/** A piece of a shell between planes of symmetry, n cells along each edge of its inner face and as
 * many through it. A sphere's is 1/24: directions (1, s, t) with 0 <= s, t <= 1. */
TetMesh shellPiece(bool sphere, int n)
{
  TetMesh mesh = makeBox({n, sphere ? n : 1, n}, Vec3::Ones());
  for (Vec3& p : mesh.nodes)
  {
    const double r = kInner + (kOuter - kInner) * p.z();
    const double angle = 0.25 * M_PI;
    p = sphere ? Vec3(r * Vec3(1.0, std::tan(angle * p.x()), std::tan(angle * p.y())).normalized())
               : Vec3(r * std::cos(2.0 * angle * p.x()), r * std::sin(2.0 * angle * p.x()),
                      kInner / n * p.y());
  }
  for (Tet& tet : mesh.tets)
  {
    if (signedVolume6(mesh.nodes[tet[0]], mesh.nodes[tet[1]], mesh.nodes[tet[2]],
                      mesh.nodes[tet[3]]) < 0.0)
    {
      std::swap(tet[0], tet[1]);
    }
  }
  return mesh;
}

/** Mean way outwards of the inner and the outer surface, m, were the pressure kPressure. */
std::array<double, 2> expansion(const Lame& lame, ElementKind kind, int n)
{
  Body body(shellPiece(lame.sphere, n), kind, lame.poisson_ratio);
  const auto radius = [&](const Vec3& p) {
    return lame.sphere ? p.norm() : std::hypot(p.x(), p.y());
  };
  const std::vector<Vec3> normals =
      lame.sphere ? std::vector<Vec3>{{0, 1, 0}, {0, 0, 1}, {1, -1, 0}, {1, 0, -1}}
                  : std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}};
  for (std::size_t i = 0; i < body.rest().size(); ++i)
  {
    const Vec3& p = body.rest()[i];
    for (const Vec3& normal : normals)
    {
      if (std::abs(normal.dot(p)) < 1e-9)
      {
        body.sliding.hold(static_cast<Index>(i), normal, Vec3::Zero());
      }
    }
    if (!lame.sphere)
    {
      body.sliding.hold(static_cast<Index>(i), Vec3::UnitZ(), p);
    }
  }
  body.press(kSmall * kPressure, [&](const Vec3& p) { return radius(p) < kInner * (1.0 + 1e-9); });
  const Points x = body.solve();
  std::array<double, 2> ways = {0.0, 0.0}, counts = {0.0, 0.0};
  for (std::size_t i = 0; i < body.rest().size(); ++i)
  {
    for (int k = 0; k < 2; ++k)
    {
      const double rest = k == 0 ? kInner : kOuter;
      if (std::abs(radius(body.rest()[i]) / rest - 1.0) < 1e-9)
      {
        ways[k] += (radius(x[i]) - rest) / kSmall;
        counts[k] += 1.0;
      }
    }
  }
  return {ways[0] / counts[0], ways[1] / counts[1]};
}

/** Prints errors on three meshes and their orders, and checks that they fall. */
void compareAll(const std::vector<Lame>& rows, int coarsest)
{
  for (const Lame& row : rows)
  {
    for (const ElementKind kind : {ElementKind::tet4, ElementKind::tet4_anp, ElementKind::tet10})
    {
      const bool linear = kind != ElementKind::tet10;
      std::array<double, 3> errors, cells;
      std::printf("  nu %.3f, %s:", row.poisson_ratio,
                  kind == ElementKind::tet4       ? "tet4"
                  : kind == ElementKind::tet4_anp ? "tet4_anp"
                                                  : "tet10");
      for (int m = 0; m < 3; ++m)
      {
        const int n = coarsest * (m + 2) / 2 * (linear ? 2 : 1);  // with as many nodes
        const std::array<double, 2> found = expansion(row, kind, n);
        cells[m] = n;
        errors[m] = std::abs(found[0] / row.inner - 1.0);
        std::printf(" %d: %+.2f, %+.2f %%;", n, 100.0 * (found[0] / row.inner - 1.0),
                    100.0 * (found[1] / row.outer - 1.0));
      }
      const auto order = [&](int m) {
        return std::log(errors[m] / errors[m + 1]) / std::log(cells[m + 1] / cells[m]);
      };
      std::printf(" orders %.2f %.2f\n", order(0), order(1));
      const double locks =
          kind == ElementKind::tet4 ? 10.0 * std::max(0.0, row.poisson_ratio - 0.3) : 0.0;
      EXPECT_GT(order(0), 1.5 - locks) << row.poisson_ratio;
      EXPECT_GT(order(1), 1.5 - locks) << row.poisson_ratio;
      EXPECT_LT(errors[2], kind == ElementKind::tet4 ? 0.25 : 0.03) << row.poisson_ratio;
    }
  }
}

// Edges are straight at rest, so round faces are met to second order whatever the element.
TEST(Lame, AHollowSphereExpandsUnderPressure)
{
  compareAll({{true, 0.3, 8.0000e-4, 3.0000e-4},
              {true, 0.45, 8.4286e-4, 2.3571e-4},
              {true, 0.499, 8.5686e-4, 2.1471e-4}},
             2);
}

TEST(Lame, APipeExpandsUnderPressure)
{
  compareAll({{false, 0.3, 1.90667e-3, 1.21333e-3},
              {false, 0.45, 1.98167e-3, 1.06333e-3},
              {false, 0.499, 1.99967e-3, 1.00133e-3}},
             4);
}

// --- A column that hangs under its own weight
// -----------------------------------------------------
TEST(HangingColumn, StretchesByItsWeight)
{
  constexpr double kLength = 0.1, kThick = 0.02, kDensity = 1000.0, kGravity = 9.81;
  constexpr double kTip = 4.905e-3;  // rho g L^2 / 2E, m
  for (const ElementKind kind : {ElementKind::tet4, ElementKind::tet10})
  {
    std::array<double, 3> errors;
    for (int m = 0; m < 3; ++m)
    {
      const int n = m + 1;
      Body body(makeBox({n, n, 5 * n}, {kThick, kThick, kLength}), kind, 0.0);
      std::vector<double> masses(body.rest().size(), 0.0);
      const std::vector<double> densities(body.tets.tets.size(), kDensity);
      if (kind == ElementKind::tet4)
      {
        addLumpedMasses(body.tets, densities, 0, masses);
      }
      else
      {
        addLoadMasses(body.quadratic, densities, 0, masses);
      }
      double way = 0.0, nodes = 0.0;
      for (std::size_t i = 0; i < masses.size(); ++i)
      {
        body.forces[i].z() = -kSmall * kGravity * masses[i];
        const Vec3& p = body.rest()[i];
        for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(0, 1, 0)})
        {
          if (std::abs(normal.dot(p)) < 1e-9)
          {
            body.sliding.hold(static_cast<Index>(i), normal, Vec3::Zero());
          }
        }
        if (p.z() > kLength - 1e-9)
        {
          body.sliding.hold(static_cast<Index>(i), Vec3::UnitZ(), p);
        }
      }
      const Points x = body.solve();
      for (std::size_t i = 0; i < masses.size(); ++i)
      {
        if (body.rest()[i].z() < 1e-9)
        {
          way -= (x[i] - body.rest()[i]).z() / kSmall;
          nodes += 1.0;
        }
      }
      errors[m] = way / nodes / kTip - 1.0;
      std::printf("  tet%s, %d cells: tip %.6f mm, %+.4f %%\n",
                  kind == ElementKind::tet4 ? "4" : "10", n, 1e3 * way / nodes, 100.0 * errors[m]);
    }
    for (const double error : errors)  // quadratic in z: exact with tet10, but for the springs
    {
      EXPECT_LT(std::abs(error), kind == ElementKind::tet10 ? 1e-4 : 1e-3);
    }
  }
}

}  // namespace
}  // namespace soft_tissue
