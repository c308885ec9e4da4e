#include "soft_tissue_sim/energy/membrane_elasticity.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/base/parallel.h"
#include "support/finite_difference.h"
#include "support/membranes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 5000.0;
constexpr double kThick = 0.1;
constexpr double kScale = kYoung * kThick;  // N/m

/** Flat and rolled rest shapes, at an ordinary, a zero, an auxetic and the incompressible ratio. */
class EveryMembrane : public ::testing::TestWithParam<std::tuple<bool, double>>
{
 protected:
  TriMesh rest() const
  {
    TriMesh mesh = smallSheet();
    mesh.nodes = std::get<0>(GetParam()) ? rolled(mesh.nodes, 2.0) : mesh.nodes;
    return mesh;
  }
  MembraneElasticity term() const
  {
    return membrane(rest(), {kYoung, std::get<1>(GetParam()), kThick});
  }
  Adjacency neighbours_ = neighboursOf(smallSheet());
};

INSTANTIATE_TEST_SUITE_P(All, EveryMembrane,
                         ::testing::Combine(::testing::Bool(),
                                            ::testing::Values(0.3, 0.0, -0.4, 0.5)));

TEST_P(EveryMembrane, IsAtRestWhereverItIsTurned)
{
  MembraneElasticity term = this->term();
  std::mt19937 random(1);
  for (int k = 0; k < 20; ++k)
  {
    const Points x = moved(rest().nodes, randomRotation(random), Vec3(0.3, -0.2, 0.5));
    EXPECT_NEAR(term.value(x), 0.0, 1e-12 * kScale);
    EXPECT_LT(gradientOf(term, x).norm(), 1e-12 * kScale);
    EXPECT_NEAR(term.smallestAreaRatio(x), 1.0, 1e-13);
  }
}

TEST_P(EveryMembrane, ResistsEveryShapeButThatAtRest)
{
  MembraneElasticity term = this->term();
  const Eigen::MatrixXd hessian = hessianOf(term, rest().nodes, neighbours_, Curvature::exact);
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues();
  EXPECT_GT(eigenvalues[0], -1e-12 * kScale);
  EXPECT_LT(eigenvalues[5], 1e-12 * kScale);  // six rigid motions
  EXPECT_GT(eigenvalues[6], 1e-5 * kScale);
}

TEST_P(EveryMembrane, EnergyDoesNotSeeRigidMotions)
{
  MembraneElasticity term = this->term();
  std::mt19937 random(2);
  for (const NamedShape& shape : sheetShapes())
  {
    const double energy = term.value(shape.x);
    const double turned = term.value(moved(shape.x, randomRotation(random), Vec3(1.0, 2.0, -3.0)));
    EXPECT_NEAR(turned, energy, 1e-11 * (kScale + energy)) << shape.name;
  }
}

TEST_P(EveryMembrane, GradientIsTheEnergysDerivative)
{
  MembraneElasticity term = this->term();
  double worst = 0.0;
  for (const NamedShape& shape : sheetShapes())
  {
    const Eigen::VectorXd gradient = gradientOf(term, shape.x);
    ASSERT_TRUE(gradient.allFinite()) << shape.name;
    const double error = (gradient - differenceGradient(term, shape.x, 1e-4)).norm();
    worst = std::max(worst, error / (kScale + gradient.norm()));
    EXPECT_LT(error, 1e-7 * (kScale + gradient.norm())) << shape.name;
    Points again(shape.x.size(), Vec3::Zero());
    const double value = term.value(shape.x);
    EXPECT_NEAR(term.valueAndGradient(shape.x, again), value, 1e-13 * value) << shape.name;
  }
  std::printf("  gradient: off its difference by at most %.1e\n", worst);
}

TEST_P(EveryMembrane, HessianIsTheGradientsDerivative)
{
  MembraneElasticity term = this->term();
  double worst = 0.0;
  for (const NamedShape& shape : sheetShapes())
  {
    const Eigen::MatrixXd hessian = hessianOf(term, shape.x, neighbours_, Curvature::exact);
    ASSERT_TRUE(hessian.allFinite()) << shape.name;
    const double size = kScale + hessian.norm();
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-12 * size) << shape.name;
    const double error = (hessian - differenceHessian(term, shape.x, 1e-4)).norm();
    worst = std::max(worst, error / size);
    EXPECT_LT(error, 1e-7 * size) << shape.name;
  }
  std::printf("  Hessian: off its difference by at most %.1e\n", worst);
}

TEST_P(EveryMembrane, PositiveHessianIsPositive)
{
  MembraneElasticity term = this->term();
  for (const auto& shapes : {sheetShapes(), collapsedShapes()})
  {
    for (const NamedShape& shape : shapes)
    {
      const Eigen::MatrixXd hessian = hessianOf(term, shape.x, neighbours_);
      ASSERT_TRUE(hessian.allFinite()) << shape.name;
      const double size = kScale + hessian.norm();
      EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-13 * size) << shape.name;
      EXPECT_GT(smallestEigenvalue(hessian), -1e-13 * size) << shape.name;
    }
  }
}

TEST_P(EveryMembrane, StaysFiniteWhereTrianglesCollapse)
{
  MembraneElasticity term = this->term();
  for (const NamedShape& shape : collapsedShapes())
  {
    const double value = term.value(shape.x);
    EXPECT_TRUE(std::isfinite(value)) << shape.name;
    EXPECT_TRUE(gradientOf(term, shape.x).allFinite()) << shape.name;
    EXPECT_LT(gradientOf(term, shape.x).norm(), 1e3 * kScale) << shape.name;
    const Eigen::MatrixXd hessian = hessianOf(term, shape.x, neighbours_, Curvature::exact);
    EXPECT_TRUE(hessian.allFinite()) << shape.name;
    EXPECT_LT(hessian.norm(), 1e5 * kScale) << shape.name;
    if (!shape.folded)  // the energy has no jump there
    {
      EXPECT_NEAR(term.value(shaken(shape.x, 1e-9, 3)), value, 1e-5 * kScale) << shape.name;
    }
  }
}

TEST_P(EveryMembrane, ForcesBalanceInSumAndMoment)
{
  MembraneElasticity term = this->term();
  for (const auto& shapes : {sheetShapes(), collapsedShapes()})
  {
    for (const NamedShape& shape : shapes)
    {
      Points gradient(shape.x.size(), Vec3::Zero());
      term.addGradient(shape.x, gradient);
      Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
      double size = 1e-3 * kScale;
      for (std::size_t node = 0; node < gradient.size(); ++node)
      {
        force += gradient[node];
        moment += shape.x[node].cross(gradient[node]);
        size += gradient[node].norm() * (1.0 + shape.x[node].norm());
      }
      EXPECT_LT(force.norm(), 1e-12 * size) << shape.name;
      EXPECT_LT(moment.norm(), 1e-12 * size) << shape.name;
    }
  }
}

TEST_P(EveryMembrane, GivesTheSameBitsOnEveryThreadCount)
{
  TriMesh mesh = makeSheet({40, 30}, {0.4, 0.3}, SheetPattern::irregular);
  const Points x = shaken(mesh.nodes, 0.003, 9);
  const Adjacency neighbours = neighboursOf(mesh);
  std::vector<std::vector<double>> results;
  for (const int threads : {1, 2, 4})
  {
    setThreadCount(threads);
    MembraneElasticity term = membrane(mesh, {kYoung, std::get<1>(GetParam()), 0.001});
    BlockMatrix exact(neighbours), positive(neighbours);
    term.addHessian(x, Curvature::exact, exact);
    term.addHessian(x, Curvature::positive, positive);
    std::vector<double> result = exact.values();
    result.insert(result.end(), positive.values().begin(), positive.values().end());
    const Eigen::VectorXd gradient = gradientOf(term, x);
    result.insert(result.end(), gradient.begin(), gradient.end());
    result.push_back(term.value(x));
    results.push_back(result);
  }
  setThreadCount(1);
  EXPECT_TRUE(results[0] == results[1]);
  EXPECT_TRUE(results[0] == results[2]);
}

}  // namespace
}  // namespace soft_tissue
