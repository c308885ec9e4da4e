#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/scene/config.h"
#include "soft_tissue_sim/solver/newton.h"
#include "support/finite_difference.h"
#include "support/quadratic_oracle.h"
#include "support/tet_quadrature.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kLength = 3.0;
constexpr double kMu = 1.0;
constexpr double kLambda = 1.25;

/** u = z (exp(x / L), exp(y / L), exp(z / L)), zero at z = 0. */
Vec3 displacement(const Vec3& p)
{
  return p.z() * (p / kLength).array().exp();
}

Mat3 deformationGradient(const Vec3& p)
{
  const Vec3 growth = (p / kLength).array().exp();
  Mat3 f = Mat3::Identity();
  f.diagonal() += p.z() / kLength * growth;
  f.col(2) += growth;
  return f;
}

/** First Piola-Kirchhoff stress of St Venant-Kirchhoff, from its formula. */
Mat3 stress(const Vec3& p)
{
  const Mat3 f = deformationGradient(p);
  const Mat3 e = 0.5 * (f.transpose() * f - Mat3::Identity());
  return f * (2.0 * kMu * e + kLambda * e.trace() * Mat3::Identity());
}

/** The force per volume that holds that stress in balance. */
Vec3 bodyForce(const Vec3& p)
{
  Vec3 force = Vec3::Zero();
  for (int j = 0; j < 3; ++j)
  {
    force -=
        derivative([&](double s) -> Vec3 { return stress(p + s * Vec3::Unit(j)).col(j); }, 0.01);
  }
  return force;
}

/** A bar with a bulging section, n cells over half of its width; inner nodes moved at random. */
TetMesh bar(int n)
{
  TetMesh mesh = makeBox({2 * n, 2 * n, 3 * n}, {2.0, 2.0, kLength});
  std::mt19937 random(3);
  for (Vec3& p : mesh.nodes)
  {
    const double x = p.x() - 1.0, y = p.y() - 1.0, z = p.z();
    const bool inner = std::max(std::abs(x), std::abs(y)) < 0.99 && z > 0.01 && z < kLength - 0.01;
    const Vec3 shake = 0.15 / n * randomMatrix(random, 1.0).col(0);
    p = Vec3(x * (1.0 - 0.2 * y * y), y * (1.0 - 0.2 * x * x), z) + (inner ? shake : Vec3::Zero());
  }
  return mesh;
}

/** Shape functions of the nodes of a quadratic tet, or of a linear one with its edge nodes unused.
 */
Eigen::Matrix<double, 10, 1> shapes(const Eigen::Vector4d& l, bool quadratic)
{
  Eigen::Matrix<double, 10, 1> n = Eigen::Matrix<double, 10, 1>::Zero();
  for (int k = 0; k < 4; ++k)
  {
    n[k] = quadratic ? l[k] * (2.0 * l[k] - 1.0) : l[k];
  }
  for (int e = 0; e < 6 && quadratic; ++e)
  {
    n[4 + e] = 4.0 * l[kTetEdges[e][0]] * l[kTetEdges[e][1]];
  }
  return n;
}

Eigen::Matrix<double, 3, 10> gradients(const QuadraticTet& n, const Points& rest,
                                       const Eigen::Vector4d& l, bool quadratic)
{
  if (quadratic)
  {
    return shapeGradients(n, rest, l);
  }
  Mat3 edges;
  edges << rest[n[1]] - rest[n[0]], rest[n[2]] - rest[n[0]], rest[n[3]] - rest[n[0]];
  Eigen::Matrix<double, 3, 10> all = Eigen::Matrix<double, 3, 10>::Zero();
  all.block<3, 3>(0, 1) = edges.inverse().transpose();
  all.col(0) = -all.block<3, 3>(0, 1).rowwise().sum();
  return all;
}

struct Errors
{
  double displacement;  ///< L2
  double gradient;      ///< L2
};

class ManufacturedSolution : public ::testing::TestWithParam<ElementKind>
{
 protected:
  bool quadratic() const { return GetParam() == ElementKind::tet10; }

  Errors errorsOn(int n) const
  {
    const TetMesh tets = bar(n);
    const QuadraticTetMesh mesh = withEdgeNodes(tets);
    const Points& rest = quadratic() ? mesh.nodes : tets.nodes;
    const auto count = static_cast<Index>(rest.size());
    const double young = kMu * (3.0 * kLambda + 2.0 * kMu) / (kLambda + kMu);
    const double poisson = 0.5 * kLambda / (kLambda + kMu);
    const std::vector<TetStiffnessParameters> all(tets.tets.size(), {young, poisson});
    std::unique_ptr<Elasticity> elasticity;
    Adjacency neighbours;
    if (quadratic())
    {
      elasticity = std::make_unique<QuadraticTetElasticity>(
          mesh, MaterialModel::st_venant_kirchhoff, all, 0);
      neighbours = nodeNeighbours(count, mesh.elements);
    }
    else
    {
      elasticity =
          std::make_unique<TetElasticity>(tets, MaterialModel::st_venant_kirchhoff, all, 0);
      neighbours = nodeNeighbours(count, tets.tets);
    }
    std::vector<Index> clamped;
    Points x;
    for (Index i = 0; i < count; ++i)
    {
      x.push_back(rest[i] + displacement(rest[i]));
      if (rest[i].z() < 1e-9)
      {
        clamped.push_back(i);
      }
    }
    NodalLoads loads(loadsOn(tets, mesh, rest.size()));
    NewtonSolver newton(neighbours, clamped, makePcg());
    NewtonOptions options;
    options.tolerance = 1e-9;
    options.max_iterations = 50;
    std::vector<EnergyTerm*> terms = {elasticity.get(), &loads};
    std::vector<double> seconds(terms.size(), 0.0);
    EXPECT_TRUE(newton.minimise(terms, options, x, seconds).converged);
    return errorsOf(mesh, rest, x);
  }

 private:
  /** Body force everywhere and traction on all of the surface but z = 0, as shape functions see
   * them. */
  Points loadsOn(const TetMesh& tets, const QuadraticTetMesh& mesh, std::size_t count) const
  {
    Points loads(count, Vec3::Zero());
    const auto add = [&](const QuadraticTet& n, const Eigen::Vector4d& l, const Vec3& force) {
      const auto values = shapes(l, quadratic());
      for (int a = 0; a < (quadratic() ? 10 : 4); ++a)
      {
        loads[n[a]] += values[a] * force;
      }
    };
    const BoundarySurface surface =
        extractBoundary(static_cast<Index>(tets.nodes.size()), tets.tets);
    const auto at = [&](const QuadraticTet& n, const Eigen::Vector4d& l) -> Vec3 {
      return l[0] * mesh.nodes[n[0]] + l[1] * mesh.nodes[n[1]] + l[2] * mesh.nodes[n[2]] +
             l[3] * mesh.nodes[n[3]];
    };
    for (const QuadraticTet& n : mesh.elements)
    {
      for (const Quadrature<4>& q : tetQuadrature())
      {
        add(n, q.l, q.weight * volumeOf(n, mesh.nodes) * bodyForce(at(n, q.l)));
      }
    }
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    {
      const QuadraticTet& n = mesh.elements[surface.triangle_tet[t]];
      const Triangle& corners = surface.triangles[t];
      const Vec3& a = mesh.nodes[corners[0]];
      const Vec3 area =
          0.5 * (mesh.nodes[corners[1]] - a).cross(mesh.nodes[corners[2]] - a);  // outwards
      for (const Quadrature<3>& q : triangleQuadrature())
      {
        Eigen::Vector4d l = Eigen::Vector4d::Zero();
        for (int k = 0; k < 3; ++k)
        {
          l[std::find(n.begin(), n.begin() + 4, corners[k]) - n.begin()] = q.l[k];
        }
        add(n, l, q.weight * stress(at(n, l)) * area);
      }
    }
    return loads;
  }

  Errors errorsOf(const QuadraticTetMesh& mesh, const Points& rest, const Points& x) const
  {
    double u = 0.0, f = 0.0;
    for (const QuadraticTet& n : mesh.elements)
    {
      for (const Quadrature<4>& q : tetQuadrature())
      {
        const auto values = shapes(q.l, quadratic());
        const auto slopes = gradients(n, mesh.nodes, q.l, quadratic());
        Vec3 place = Vec3::Zero(), moved = Vec3::Zero();
        Mat3 found = Mat3::Zero();
        for (int a = 0; a < (quadratic() ? 10 : 4); ++a)
        {
          place += values[a] * rest[n[a]];
          moved += values[a] * x[n[a]];
          found += x[n[a]] * slopes.col(a).transpose();
        }
        const double weight = q.weight * volumeOf(n, mesh.nodes);
        u += weight * (moved - place - displacement(place)).squaredNorm();
        f += weight * (found - deformationGradient(place)).squaredNorm();
      }
    }
    return {std::sqrt(u), std::sqrt(f)};
  }
};

INSTANTIATE_TEST_SUITE_P(Elements, ManufacturedSolution,
                         ::testing::Values(ElementKind::tet4, ElementKind::tet10));

TEST_P(ManufacturedSolution, ErrorsFallWithTheOrderOfTheElement)
{
  const double order = quadratic() ? 3.0 : 2.0;
  const std::vector<int> meshes =
      quadratic() ? std::vector<int>{1, 2, 4} : std::vector<int>{2, 4, 8};
  std::vector<Errors> errors;
  for (const int n : meshes)
  {
    errors.push_back(errorsOn(n));
    std::printf("  tet%s, h 1/%d: u off by %.3e, F by %.3e", quadratic() ? "10" : "4", n,
                errors.back().displacement, errors.back().gradient);
    if (errors.size() > 1)
    {
      const Errors& coarse = errors[errors.size() - 2];
      const Errors& fine = errors.back();
      const double of_u = std::log2(coarse.displacement / fine.displacement);
      const double of_f = std::log2(coarse.gradient / fine.gradient);
      std::printf(", orders %.2f, %.2f", of_u, of_f);
      EXPECT_NEAR(of_u, order, 0.25);
      EXPECT_NEAR(of_f, order - 1.0, 0.2);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace soft_tissue
