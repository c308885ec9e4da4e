#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/cantilever.h"

namespace soft_tissue
{
namespace
{
using namespace test;

class QuadraticCantilever : public ::testing::TestWithParam<MaterialModel>
{
 protected:
  BeamTip tipOf(const BeamLoad& load, int cells)
  {
    Cantilever beam(GetParam(), cells, ElementKind::tet10);
    Points x = beam.rest().nodes;
    const NewtonReport report = beam.bend(load, x);
    EXPECT_TRUE(report.converged) << "residual " << report.residual;
    const BeamTip tip = beam.tip(x);
    std::printf("  alpha %g beta %g, %d cells, %zu elements, %zu nodes, %d Newton: %.5f %.5f\n",
                load.tip, load.weight, cells, beam.elements(), beam.rest().nodes.size(),
                report.iterations, tip.down, tip.along);
    return tip;
  }
};

INSTANTIATE_TEST_SUITE_P(Materials, QuadraticCantilever,
                         ::testing::Values(MaterialModel::corotated, MaterialModel::neo_hookean));

/** How far the tip should be down: that of a rod which stretches and shears. */
double rodDown(BeamLoad load)
{
  load.stretch = 1.0 / (12.0 * Cantilever::kSlender * Cantilever::kSlender);
  load.shear = 2.0 / (5.0 / 6.0) * load.stretch;  // E / G = 2, k = 5/6
  return Rod(load).tip().down;
}

TEST_P(QuadraticCantilever, BendsAsARodWithOneElementOverTheThickness)
{
  for (const BeamLoad& load : {BeamLoad{0.2}, BeamLoad{1.0}, BeamLoad{4.0}, BeamLoad{0.0, 0.5},
                               BeamLoad{0.0, 2.0}, BeamLoad{0.0, 8.0}})
  {
    const double rod = rodDown(load);
    for (const int cells : {1, 2})
    {
      const double down = tipOf(load, cells).down;
      std::printf("    off the rod by %+.3f %%\n", 100.0 * (down / rod - 1.0));
      EXPECT_NEAR(down, rod, 0.003 * rod) << cells;
    }
  }
}

// Energies converge with the fourth power of the size of quadratic elements; so does what a small
// load does at its own place. At the clamp's edges stress is unbounded, and some of it gets lost.
TEST_P(QuadraticCantilever, ConvergesWithMoreThanTheThirdPower)
{
  const BeamLoad load = {0.2};
  const double one = tipOf(load, 1).down, two = tipOf(load, 2).down, four = tipOf(load, 4).down;
  const double order = std::log2((two - one) / (four - two));
  std::printf("    order %.2f\n", order);
  EXPECT_GT(order, 3.0);
  EXPECT_LT(order, 4.3);
}

}  // namespace
}  // namespace soft_tissue
