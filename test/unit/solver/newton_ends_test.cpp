#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/pulled_block.h"
#include "support/simple_terms.h"

namespace soft_tissue
{
namespace
{
using namespace test;

double farthest(const Points& a, const Points& b)
{
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    most = std::max(most, (a[i] - b[i]).norm());
  }
  return most;
}

TEST(NewtonSolver, EndsWhereNodesAreSettled)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  NewtonSolver newton = block.newton(makeCholesky());
  Points end = block.mesh.nodes;
  const int all = minimise(newton, block.terms, optionsOf(1e-13, 50), end).iterations;
  int last = all;
  for (const double settled : {1e-9, 1e-6, 1e-4})
  {
    NewtonOptions options = optionsOf(1e-13, 50);
    options.settled = settled;
    Points x = block.mesh.nodes;
    const NewtonReport report = minimise(newton, block.terms, options, x);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.iterations, last);
    last = report.iterations;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      EXPECT_LT((x[i] - end[i]).norm(), 2.0 * settled) << settled;  // it is an estimate
    }
  }
  EXPECT_LT(last, all);
}

/** A stiff block on soft ground, pulled apart and, a little, along: what pulls apart hides what
 * moves it. */
TEST(NewtonSolver, DoesNotTakeWhatAStiffBodyHidesForSettled)
{
  const TetMesh mesh = makeBox({2, 2, 5}, {0.02, 0.02, 0.05});
  const auto count = static_cast<Index>(mesh.nodes.size());
  TetElasticity elasticity(mesh, MaterialModel::linear, {mesh.tets.size(), {5e9, 0.3}}, 0);
  SeparableTerm ground([](double x) { return 0.5 * x * x; }, [](double x) { return x; },
                       [](double) { return 1.0; });
  Points pull(mesh.nodes.size(), Vec3::Zero());
  for (Index i = 0; i < count; ++i)
  {
    pull[i].z() = (mesh.nodes[i].z() > 0.0249 ? 100.0 : -100.0);
    pull[i].x() = 1e-2;
  }
  NodalLoads loads(pull);
  const Terms terms = {&elasticity, &ground, &loads};
  const Adjacency neighbours = nodeNeighbours(count, mesh.tets);
  NewtonSolver exact(neighbours, {}, makeCholesky()), newton(neighbours, {}, makePcg());
  Points end = mesh.nodes, x = mesh.nodes;
  minimise(exact, terms, optionsOf(1e-13, 50), end);
  ASSERT_GT(farthest(end, mesh.nodes), 1e-3);
  NewtonOptions options = optionsOf(1e-12, 50);
  options.settled = 1e-6;
  EXPECT_TRUE(minimise(newton, terms, options, x).converged);
  EXPECT_LT(farthest(x, end), 2.0 * options.settled);
}

TEST(NewtonSolver, EndsWhenItsTimeIsUp)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  Points end = block.mesh.nodes;
  NewtonSolver patient = block.newton(makePcg());
  EXPECT_FALSE(minimise(patient, block.terms, optionsOf(1e-12, 50), end).out_of_time);

  NewtonSolver newton = block.newton(makePcg());
  NewtonOptions options = optionsOf(1e-6, 50);
  options.budget_s = 0.0;
  std::vector<double> seconds(block.terms.size(), 0.0);
  Points x = block.mesh.nodes;
  double potential = block.elasticity.value(x) + block.loads.value(x);
  for (int call = 0;; ++call)
  {
    ASSERT_LT(call, 300);
    const NewtonReport report = newton.minimise(block.terms, options, x, seconds);
    EXPECT_EQ(report.iterations, 1) << "the first iteration is done in any case";
    EXPECT_EQ(report.value, block.elasticity.value(x) + block.loads.value(x));
    EXPECT_LE(report.value, potential + 1e-12) << "what is done leads down";
    potential = report.value;
    if (report.converged)
    {
      break;
    }
    EXPECT_TRUE(report.out_of_time);
    if (call > 0)
    {
      EXPECT_LE(report.linear_iterations, 8) << "of linear iterations, only the fewest";
    }
  }
  EXPECT_LT(farthest(x, end), 1e-5 * farthest(block.mesh.nodes, end));
}

TEST(NewtonSolver, TellsHowFarTheEndIs)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  Points end = block.mesh.nodes;
  NewtonSolver newton = block.newton(makeCholesky());
  minimise(newton, block.terms, optionsOf(1e-13, 50), end);
  for (const int iterations : {1, 2, 3})
  {
    Points x = block.mesh.nodes;
    const NewtonReport report = minimise(newton, block.terms, optionsOf(1e-13, iterations), x);
    const double truth = farthest(x, end);
    EXPECT_GT(report.position_error_m, 0.1 * truth) << iterations;
    EXPECT_LT(report.position_error_m, 10.0 * truth) << iterations;
  }
  NewtonSolver fresh = block.newton(makeCholesky());
  Points x = block.mesh.nodes;
  EXPECT_TRUE(std::isnan(minimise(fresh, block.terms, optionsOf(1e-13, 0), x).position_error_m));
}

/** Another term, that counts how often its second derivative is asked for. */
class CountedTerm : public EnergyTerm
{
 public:
  explicit CountedTerm(EnergyTerm& term) : term_(term) {}
  double value(const Points& x) override { return term_.value(x); }
  void addGradient(const Points& x, Points& gradient) override { term_.addGradient(x, gradient); }
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override
  {
    ++hessians;
    term_.addHessian(x, curvature, hessian);
  }

  int hessians = 0;

 private:
  EnergyTerm& term_;
};

TEST(NewtonSolver, SecondDerivativesServeAsLongAsTheyLeadWhereTheyShould)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  CountedTerm counted(block.elasticity);
  const Terms terms = {&counted, &block.loads};
  NewtonSolver newton = block.newton(makeCholesky());
  std::vector<double> seconds(terms.size(), 0.0);
  Points x = block.mesh.nodes;
  ASSERT_TRUE(newton.minimise(terms, optionsOf(1e-6, 50), x, seconds).converged);
  const auto hessiansAfterMoving = [&](double share, bool forget) {
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      x[i] += share * (x[i] - block.mesh.nodes[i]);
    }
    const int before = counted.hessians;
    if (forget)
    {
      newton.forgetMatrix();
    }
    EXPECT_TRUE(newton.minimise(terms, optionsOf(1e-6, 50), x, seconds).converged);
    return counted.hessians - before;
  };
  EXPECT_EQ(hessiansAfterMoving(1e-4, false), 0);
  EXPECT_EQ(hessiansAfterMoving(1e-4, true), 1);
  EXPECT_GE(hessiansAfterMoving(2.0, false), 1);
  // Other terms have other second derivatives.
  const int before = counted.hessians;
  const Terms alone = {&counted};
  newton.minimise(alone, optionsOf(1e-6, 50), x, seconds);
  EXPECT_GT(counted.hessians, before);
}

TEST(NewtonSolver, StartsFromTheLowerOfTwoStates)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  NewtonSolver newton = block.newton(makeCholesky());
  Points end = block.mesh.nodes;
  const int all = minimise(newton, block.terms, optionsOf(1e-10, 50), end).iterations;
  const auto iterationsWith = [&](Points other, Points& x) {
    std::vector<double> seconds(block.terms.size(), 0.0);
    newton.forgetMatrix();
    return newton.minimise(block.terms, optionsOf(1e-10, 50), x, seconds, &other).iterations;
  };
  Points x = block.mesh.nodes;
  EXPECT_LT(iterationsWith(end, x), all);
  Points far = block.mesh.nodes, from_far = block.mesh.nodes;
  for (std::size_t i = 0; i < far.size(); ++i)
  {
    const bool fixed = std::count(block.fixed.begin(), block.fixed.end(), Index(i)) > 0;
    far[i] *= fixed ? 1.0 : 3.0;
  }
  EXPECT_EQ(iterationsWith(far, from_far), all);
  EXPECT_EQ(from_far, end);
  far[0].x() = std::numeric_limits<double>::quiet_NaN();
  from_far = block.mesh.nodes;
  EXPECT_EQ(iterationsWith(far, from_far), all);
  EXPECT_EQ(from_far, end);
}

}  // namespace
}  // namespace soft_tissue
