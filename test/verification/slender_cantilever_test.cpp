#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "support/cantilever.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** Length over thickness: so slender that the elastica is all there is to a beam. */
constexpr double kSlender = 100.0;
constexpr std::array<int, 4> kAlong = {10, 20, 40, 80};  // cells along the beam, one across

class SlenderCantilever : public ::testing::Test
{
 protected:
  /** Bends beams of one element kind by one load after the other; tips by mesh, then load. */
  std::array<std::vector<BeamTip>, 4> bendAll(ElementKind kind, const std::vector<BeamLoad>& loads)
  {
    std::array<std::vector<BeamTip>, 4> tips;
    for (std::size_t m = 0; m < kAlong.size(); ++m)
    {
      Cantilever beam(MaterialModel::corotated, {kAlong[m], 1, 1}, kSlender, kind);
      Points x = beam.rest().nodes;
      for (const BeamLoad& load : loads)
      {
        const NewtonReport report = beam.bend(load, x);
        EXPECT_TRUE(report.converged) << kAlong[m] << " cells, residual " << report.residual;
        tips[m].push_back(beam.tip(x));
      }
    }
    return tips;
  }

  void compare(const std::vector<BeamLoad>& loads)
  {
    const auto linear = bendAll(ElementKind::tet4, loads);
    const auto quadratic = bendAll(ElementKind::tet10, loads);
    for (std::size_t k = 0; k < loads.size(); ++k)
    {
      const BeamTip exact = Rod(loads[k]).tip();
      std::array<double, 4> errors;
      std::printf("  alpha %g beta %g, elastica w %.5f u %.5f\n   ", loads[k].tip, loads[k].weight,
                  exact.down, exact.along);
      for (std::size_t m = 0; m < kAlong.size(); ++m)
      {
        errors[m] =
            std::hypot(quadratic[m][k].down - exact.down, quadratic[m][k].along - exact.along);
        std::printf(" %d: %+.3f, %+.3f %%;", kAlong[m],
                    100.0 * (quadratic[m][k].down / exact.down - 1.0),
                    100.0 * (quadratic[m][k].along / exact.along - 1.0));
      }
      const double order = std::log2(errors[0] / errors[1]),
                   next = std::log2(errors[1] / errors[2]);
      std::printf(" orders %.2f %.2f; tet4: w %+.1f %%\n", order, next,
                  100.0 * (linear[3][k].down / exact.down - 1.0));
      EXPECT_GT(order, 2.3);
      EXPECT_GT(next, 3.0);
      EXPECT_LT(errors[3], 3e-4);
      EXPECT_LT(linear[3][k].down, quadratic[0][k].down) << "linear tets this flat lock";
    }
  }
};

TEST_F(SlenderCantilever, IsTheElasticaUnderATipLoad)
{
  compare({{0.2}, {0.5}, {1.0}, {2.0}, {4.0}, {7.0}, {10.0}});
}

TEST_F(SlenderCantilever, IsTheHeavyElasticaUnderItsOwnWeight)
{
  compare({{0.0, 0.5},
           {0.0, 1.0},
           {0.0, 2.0},
           {0.0, 4.0},
           {0.0, 8.0},
           {0.0, 10.0},
           {0.0, 16.0},
           {0.0, 32.0}});
}

}  // namespace
}  // namespace soft_tissue
