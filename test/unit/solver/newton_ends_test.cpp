#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/pulled_block.h"

namespace soft_tissue
{
namespace
{
using namespace test;

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
