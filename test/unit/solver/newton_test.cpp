#include "soft_tissue_sim/solver/newton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_tissue_sim/base/parallel.h"
#include "support/pulled_block.h"
#include "support/simple_terms.h"

namespace soft_tissue
{
namespace
{
using namespace test;

double valueOf(const Terms& terms, const Points& x)
{
  double sum = 0.0;
  for (EnergyTerm* term : terms)
  {
    sum += term->value(x);
  }
  return sum;
}

/** The relative residual by its definition in NewtonOptions. */
double residualOf(const Terms& terms, const std::vector<Index>& fixed, const Points& x)
{
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(3 * x.size());
  double size = 0.0;
  for (EnergyTerm* term : terms)
  {
    Points gradient(x.size(), Vec3::Zero());
    term->addGradient(x, gradient);
    for (const Index node : fixed)
    {
      gradient[node].setZero();
    }
    sum += flat(gradient);
    size += flat(gradient).norm();
  }
  return sum.norm() / size;
}

TEST(NewtonSolver, SolvesAQuadraticInOneIteration)
{
  const std::vector<Tet> tets = randomTets(30, 60, 1);
  BlockMatrix a(nodeNeighbours(30, tets));
  addRandomElements(tets, 2, a);
  for (Index i = 0; i < 30; ++i)
  {
    addDiagonal(a, i, 0.5);
  }
  const Points centre = randomPoints(30, 3);
  QuadraticTerm quadratic(a, centre);
  NodalLoads loads(randomPoints(30, 4));
  NewtonSolver newton(nodeNeighbours(30, tets), {}, makeCholesky());
  Points x = randomPoints(30, 5);
  const NewtonReport report = minimise(newton, {&quadratic, &loads}, optionsOf(1e-9, 20), x);
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(report.finite);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(report.linear_iterations, 1);
  EXPECT_LT(residualOf({&quadratic, &loads}, {}, x), 1e-9);
}

TEST(NewtonSolver, DoesNothingAtAMinimum)
{
  const Points centre = randomPoints(3, 11);
  BlockMatrix a(noNeighbours(3));
  for (Index i = 0; i < 3; ++i)
  {
    addDiagonal(a, i, 1.0);
  }
  QuadraticTerm quadratic(a, centre);
  NewtonSolver newton(noNeighbours(3), {}, makePcg());
  Points x = centre;
  const NewtonReport report = minimise(newton, {&quadratic}, optionsOf(1e-6, 20), x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.residual, 0.0);
  EXPECT_EQ(x, centre);
}

// All that is left of the forces of a body at rest are rounding errors: it is at its minimum.
TEST(NewtonSolver, LeavesABodyAtRestWhereItIs)
{
  PulledBlock block(Vec3::Zero());
  for (const bool direct : {false, true})
  {
    NewtonSolver newton = block.newton(direct ? makeCholesky() : makePcg());
    Points x = block.mesh.nodes;
    const NewtonReport report = minimise(newton, {&block.elasticity}, optionsOf(1e-3, 20), x);
    EXPECT_TRUE(report.converged) << report.residual;
    EXPECT_LE(report.iterations, 1);
    EXPECT_LT((flat(x) - flat(block.mesh.nodes)).lpNorm<Eigen::Infinity>(), 1e-15);
  }
}

TEST(NewtonSolver, ConvergesQuadratically)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  NewtonSolver newton = block.newton(makeCholesky());
  Points x = block.mesh.nodes;
  std::vector<double> residuals = {residualOf(block.terms, block.fixed, x)};
  for (int k = 0; k < 12 && residuals.back() > 1e-12; ++k)
  {
    minimise(newton, block.terms, optionsOf(1e-14, 1), x);
    residuals.push_back(residualOf(block.terms, block.fixed, x));
  }
  ASSERT_LT(residuals.back(), 1e-11);
  int checked = 0;
  for (std::size_t k = 0; k + 1 < residuals.size(); ++k)
  {
    if (residuals[k] < 0.02 && residuals[k] > 1e-6)
    {
      // The constant is about one: strains and the material's own scale are of that size.
      EXPECT_LT(residuals[k + 1], 10.0 * residuals[k] * residuals[k]) << "iteration " << k;
      ++checked;
    }
  }
  EXPECT_GE(checked, 1);
}

TEST(NewtonSolver, ReachesTheToleranceAskedForAndReportsTheResidual)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  for (const bool direct : {false, true})
  {
    NewtonSolver newton = block.newton(direct ? makeCholesky() : makePcg());
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10})
    {
      Points x = block.mesh.nodes;
      const NewtonReport report = minimise(newton, block.terms, optionsOf(tolerance, 100), x);
      EXPECT_TRUE(report.converged) << tolerance;
      EXPECT_LE(report.residual, tolerance);
      EXPECT_LE(report.iterations, 12) << tolerance;
      EXPECT_NEAR(report.residual, residualOf(block.terms, block.fixed, x),
                  1e-6 * report.residual + 1e-14);
    }
  }
}

TEST(NewtonSolver, SaysHonestlyThatItWasStopped)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  NewtonSolver newton = block.newton(makeCholesky());
  Points x = block.mesh.nodes;
  const NewtonReport report = minimise(newton, block.terms, optionsOf(1e-10, 2), x);
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(report.finite);
  EXPECT_EQ(report.iterations, 2);
  EXPECT_GT(report.residual, 1e-10);
  EXPECT_NEAR(report.residual, residualOf(block.terms, block.fixed, x), 1e-6 * report.residual);
}

TEST(NewtonSolver, KeepsFixedNodesBitByBit)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  for (const bool direct : {false, true})
  {
    NewtonSolver newton = block.newton(direct ? makeCholesky() : makePcg());
    Points x = block.mesh.nodes;
    for (Vec3& p : x)
    {
      p += Vec3(0.1, 1.0 / 3.0, -0.7);
    }
    const Points start = x;
    minimise(newton, block.terms, optionsOf(1e-6, 50), x);
    for (const Index node : block.fixed)
    {
      EXPECT_EQ(x[node], start[node]);
    }
    EXPECT_NE(x, start);
    Points other(x.size(), Vec3::Zero());
    newton.restoreFixed(start, other);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      const bool fixed = std::count(block.fixed.begin(), block.fixed.end(), Index(i)) > 0;
      EXPECT_EQ(other[i], fixed ? start[i] : Vec3(Vec3::Zero()));
    }
  }
}

TEST(NewtonSolver, NeverGoesUp)
{
  for (const double poisson_ratio : {0.0, 0.4, 0.49})
  {
    PulledBlock block({0.3 * kPull, 0.0, kPull}, poisson_ratio);
    NewtonSolver newton = block.newton(makeCholesky());
    Points x = block.mesh.nodes;
    const Points mess = randomPoints(static_cast<Index>(x.size()), 21);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      x[i] += 0.02 * mess[i];  // twice an edge: many tets inverted
    }
    ASSERT_LT(block.elasticity.minDetF(x), -1.0);
    double before = valueOf(block.terms, x);
    NewtonReport report;
    int iterations = 0;
    do
    {
      report = minimise(newton, block.terms, optionsOf(1e-6, 1), x);
      const double now = valueOf(block.terms, x);
      ASSERT_TRUE(std::isfinite(now));
      EXPECT_LE(now, before + 1e-13 * std::abs(before)) << "iteration " << iterations;
      before = now;
    } while (!report.converged && ++iterations < 300);
    EXPECT_TRUE(report.converged) << "nu " << poisson_ratio << ", residual " << report.residual;
  }
}

TEST(NewtonSolver, TurnsAnInvertedTetBack)
{
  const TetMesh mesh = unitTet();
  for (const MaterialModel model : {MaterialModel::neo_hookean, MaterialModel::corotated})
  {
    TetElasticity elasticity(mesh, model, {{5000.0, 0.3}}, 0);
    NewtonSolver newton(nodeNeighbours(4, mesh.tets), {0, 1, 2}, makeCholesky());
    Points x = mesh.nodes;
    x[3] = Vec3(0.2, 0.1, -0.4);
    minimise(newton, {&elasticity}, optionsOf(1e-8, 100), x);
    EXPECT_LT((x[3] - mesh.nodes[3]).norm(), 1e-6) << static_cast<int>(model);
  }
}

// f = x - log x has its minimum at 1, no number for x <= 0, and Newton's full step leads from any
// x > 2 to x (2 - x) < 0.
TEST(NewtonSolver, NeverAcceptsWhatIsNotANumber)
{
  SeparableTerm barrier([](double x) { return x - std::log(x); },
                        [](double x) { return 1.0 - 1.0 / x; },
                        [](double x) { return 1.0 / (x * x); });
  NewtonSolver newton(noNeighbours(1), {}, makeCholesky());
  Points x = {Vec3(2.5, 7.0, 40.0)};
  for (int k = 0; k < 100; ++k)
  {
    const NewtonReport report = minimise(newton, {&barrier}, optionsOf(1e-12, 1), x);
    ASSERT_TRUE(x[0].allFinite());
    ASSERT_GT(x[0].minCoeff(), 0.0);
    EXPECT_TRUE(report.finite);
  }
  EXPECT_LT((x[0] - Vec3::Ones()).norm(), 1e-9);
}

TEST(NewtonSolver, KeepsItsStartWhenForcesOrEnergyAreNoNumbers)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const auto one = [](double) { return 1.0; };
  for (const double bad : {nan, infinity})
  {
    const auto broken = [bad](double) { return bad; };
    SeparableTerm force(one, broken, one), energy(broken, one, one), curvature(one, one, broken);
    for (SeparableTerm* term : {&force, &energy, &curvature})
    {
      for (const bool direct : {false, true})
      {
        NewtonSolver newton(noNeighbours(2), {}, direct ? makeCholesky() : makePcg());
        const Points start = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
        Points x = start;
        const NewtonReport report = minimise(newton, {term}, optionsOf(1e-6, 20), x);
        EXPECT_FALSE(report.converged);
        EXPECT_EQ(x, start);
        if (term != &curvature)
        {
          EXPECT_FALSE(report.finite);
        }
      }
    }
  }
}

// The energy has numbers everywhere and looks lower beyond 1, where the force has none.
TEST(NewtonSolver, StepsBackFromForcesThatAreNoNumbers)
{
  SeparableTerm trap([](double x) { return -x; },
                     [](double x) { return x > 1.0 ? std::nan("") : -1.0; },
                     [](double) { return 1.0; });
  NewtonSolver newton(noNeighbours(1), {}, makeCholesky());
  Points x = {Vec3(0.5, 0.5, 0.5)};
  const NewtonReport report = minimise(newton, {&trap}, optionsOf(1e-6, 20), x);
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(report.finite) << "it never went where they are none";
  EXPECT_TRUE(x[0].allFinite());
  EXPECT_GT(x[0].minCoeff(), 0.5);
  EXPECT_LE(x[0].maxCoeff(), 1.0);
}

TEST(NewtonSolver, LeavesAHilltop)
{
  // (x^2 - 1)^2: curvature is negative for |x| < 1 / sqrt(3).
  SeparableTerm wells([](double x) { return (x * x - 1.0) * (x * x - 1.0); },
                      [](double x) { return 4.0 * x * (x * x - 1.0); },
                      [](double x) { return 12.0 * x * x - 4.0; });
  BlockMatrix a(noNeighbours(1));
  addDiagonal(a, 0, 1e-3);
  QuadraticTerm weak(a, {Vec3::Zero()});
  for (const bool direct : {false, true})
  {
    NewtonSolver newton(noNeighbours(1), {}, direct ? makeCholesky() : makePcg());
    Points x = {Vec3(0.1, -0.3, 0.5)};
    const NewtonReport report = minimise(newton, {&wells, &weak}, optionsOf(1e-8, 100), x);
    EXPECT_TRUE(report.converged) << report.residual;
    const double well = std::sqrt(1.0 - 1e-3 / 4.0);
    EXPECT_LT((x[0].cwiseAbs() - Vec3::Constant(well)).norm(), 1e-6);
    EXPECT_GT(x[0].x(), 0.0);
    EXPECT_LT(x[0].y(), 0.0);
  }
}

TEST(NewtonSolver, HasTheSameBitsForAnyThreadCount)
{
  std::vector<Points> results;
  for (const int threads : {1, 2, 1})
  {
    setThreadCount(threads);
    PulledBlock block({0.3 * kPull, 0.0, kPull});
    NewtonSolver newton = block.newton(makePcg());
    results.push_back(block.mesh.nodes);
    minimise(newton, block.terms, optionsOf(1e-8, 50), results.back());
  }
  setThreadCount(1);
  EXPECT_EQ(results[1], results[0]);
  EXPECT_EQ(results[2], results[0]);
}

}  // namespace
}  // namespace soft_tissue
