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

// One or two elements over the thickness do what linear ones need twelve cells for.
TEST_P(QuadraticCantilever, BendsAsARodWithFewElements)
{
  for (BeamLoad load : {BeamLoad{0.2}, BeamLoad{1.0}, BeamLoad{4.0}, BeamLoad{0.0, 0.5},
                        BeamLoad{0.0, 2.0}, BeamLoad{0.0, 8.0}})
  {
    const BeamTip one = tipOf(load, 1), two = tipOf(load, 2), four = tipOf(load, 4);
    load.stretch = 1.0 / (12.0 * Cantilever::kSlender * Cantilever::kSlender);
    load.shear = 2.0 / (5.0 / 6.0) * load.stretch;
    const BeamTip rod = Rod(load).tip();
    std::printf(
        "    rod %.5f %.5f: off by %+.2f %+.2f %+.2f %%, %+.2f %+.2f %+.2f %%; order %.1f\n",
        rod.down, rod.along, 100.0 * (one.down / rod.down - 1.0),
        100.0 * (two.down / rod.down - 1.0), 100.0 * (four.down / rod.down - 1.0),
        100.0 * (one.along / rod.along - 1.0), 100.0 * (two.along / rod.along - 1.0),
        100.0 * (four.along / rod.along - 1.0),
        std::log2((two.down - one.down) / (four.down - two.down)));
    EXPECT_NEAR(two.down, rod.down, 0.003 * rod.down);
  }
}

}  // namespace
}  // namespace soft_tissue
