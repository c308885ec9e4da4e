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

TEST(NewtonSolver, StartsFromTheLowerOfTwoStates)
{
  PulledBlock block({0.3 * kPull, 0.0, kPull});
  NewtonSolver newton = block.newton(makeCholesky());
  Points end = block.mesh.nodes;
  const int all = minimise(newton, block.terms, optionsOf(1e-10, 50), end).iterations;
  const auto iterationsWith = [&](Points other, Points& x) {
    std::vector<double> seconds(block.terms.size(), 0.0);
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
