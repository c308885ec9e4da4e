#include "support/cantilever.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>

namespace soft_tissue
{
namespace
{
using namespace test;

struct Published
{
  BeamLoad load;
  double down;
  double along;
};

/** Tip of the elastica under a dead tip load (alpha) and under its own weight (beta). */
const std::vector<Published> kTipLoads = {{{0.2}, 0.06636, 0.00265}, {{0.5}, 0.16214, 0.01592},
                                          {{1.0}, 0.30172, 0.05643}, {{2.0}, 0.49346, 0.16064},
                                          {{4.0}, 0.66996, 0.32894}, {{7.0}, 0.76737, 0.47293},
                                          {{10.0}, 0.81061, 0.55500}};
const std::vector<Published> kWeights = {
    {{0.0, 0.5}, 0.06231, 0.00222},  {{0.0, 1.0}, 0.12347, 0.00875},
    {{0.0, 2.0}, 0.23851, 0.03311},  {{0.0, 4.0}, 0.42516, 0.10989},
    {{0.0, 8.0}, 0.64063, 0.27558},  {{0.0, 10.0}, 0.70020, 0.34365},
    {{0.0, 16.0}, 0.79702, 0.49001}, {{0.0, 32.0}, 0.87846, 0.67151}};

TEST(Rod, IsTheElasticaWithoutStretchAndShear)
{
  for (const auto* table : {&kTipLoads, &kWeights})
  {
    for (const Published& row : *table)
    {
      const BeamTip tip = Rod(row.load).tip();
      EXPECT_NEAR(tip.down, row.down, 6e-6) << row.load.tip << " " << row.load.weight;
      EXPECT_NEAR(tip.along, row.along, 6e-6) << row.load.tip << " " << row.load.weight;
    }
  }
}

TEST(Rod, HasTheDeflectionOfATimoshenkoBeamUnderASmallLoad)
{
  const BeamLoad load = {1e-4, 2e-4, 0.0, 0.03};
  const double exact = 1e-4 * (1.0 / 3.0 + 0.03) + 2e-4 * (1.0 / 8.0 + 0.03 / 2.0);
  EXPECT_NEAR(Rod(load).tip().down, exact, 1e-7 * exact);
}

constexpr int kMeshes = 3;
constexpr int kCoarsest = 3;  // cells over the thickness
constexpr int kFinest = kCoarsest << (kMeshes - 1);

/**
 * A beam of n cubes over its thickness is too stiff by at most this over n^2. Bent to a curvature
 * k, the mesh could at worst follow the exact displacement at its nodes: then the stretch k z of
 * each tet is that of its upper or lower face, the trapezoidal rule for h^2 / 12, off by 2 / n^2;
 * and each tet shears by k h / 2n, with G = E / 2 another 1.5 / n^2.
 */
constexpr double kTooStiff = 3.5;

class CantileverBends : public ::testing::TestWithParam<MaterialModel>
{
 protected:
  /** Bends the beam on every mesh: the coarsest from straight, each finer one from the coarser. */
  void bendAll(const std::vector<Published>& loads, const std::vector<BeamTip>& expected)
  {
    std::vector<std::unique_ptr<Cantilever>> beams;
    for (int m = 0; m < kMeshes; ++m)
    {
      beams.push_back(std::make_unique<Cantilever>(GetParam(), kCoarsest << m));
    }
    Points coarse = beams[0]->rest().nodes;
    for (std::size_t k = 0; k < loads.size(); ++k)
    {
      Points x = coarse;
      BeamTip tips[kMeshes];
      for (int m = 0; m < kMeshes; ++m)
      {
        if (m > 0)
        {
          x = Cantilever::refined(*beams[m - 1], x, *beams[m]);
        }
        const NewtonReport report = beams[m]->bend(loads[k].load, x);
        ASSERT_TRUE(report.converged) << "residual " << report.residual;
        tips[m] = beams[m]->tip(x);
        std::printf("  %2d cells, %5zu tets, %3d Newton:", kCoarsest << m,
                    beams[m]->rest().tets.size(), report.iterations);
        std::printf(" w/L %.5f (%+.2f %%) u/L %.5f (%+.2f %%)\n", tips[m].down,
                    100.0 * (tips[m].down / loads[k].down - 1.0), tips[m].along,
                    100.0 * (tips[m].along / loads[k].along - 1.0));
        if (m == 0)
        {
          coarse = x;
        }
      }
      check(loads[k], expected[k], tips);
    }
  }

  static std::vector<BeamTip> rods(const std::vector<Published>& loads)
  {
    std::vector<BeamTip> tips;
    for (const Published& row : loads)
    {
      BeamLoad load = row.load;
      load.stretch = 1.0 / (12.0 * Cantilever::kSlender * Cantilever::kSlender);
      load.shear = 2.0 / (5.0 / 6.0) * load.stretch;  // E / G = 2, k = 5/6
      tips.push_back(Rod(load).tip());
    }
    return tips;
  }

 private:
  static void check(const Published& row, const BeamTip& rod, const BeamTip* tips)
  {
    checkOne(row, "w/L", rod.down, row.down, {tips[0].down, tips[1].down, tips[2].down}, 1.0);
    // Towards the clamp the tip goes by the square of the slope: twice the relative error.
    checkOne(row, "u/L", rod.along, row.along, {tips[0].along, tips[1].along, tips[2].along}, 2.0);
  }

  static void checkOne(const Published& row, const char* what, double rod, double elastica,
                       const std::array<double, kMeshes>& on, double power)
  {
    const std::string load = (row.load.tip > 0.0 ? "alpha " : "beta ") +
                             testing::PrintToString(row.load.tip + row.load.weight);
    const double coarse = on[1], fine = on[2];
    // A small load leaves the rod exact enough to be the reference; under a large one the rod is
    // off by as much as the finest mesh, and the meshes are compared with each other.
    const double strain = (row.load.tip + 0.5 * row.load.weight) * (1.0 - row.along) /
                          (2.0 * Cantilever::kSlender);  // at the clamp's surface
    const double order = strain < 0.03 ? std::log2((rod - coarse) / (rod - fine))
                                       : std::log2((coarse - on[0]) / (fine - coarse));
    const double limit = fine + (fine - coarse) / 3.0;
    std::printf("  %s %s: order %.2f, limit %.5f: elastica %+.2f %%, rod %+.2f %%\n", load.c_str(),
                what, order, limit, 100.0 * (limit / elastica - 1.0), 100.0 * (limit / rod - 1.0));
    EXPECT_GT(order, 1.6) << load << " " << what;
    EXPECT_LT(order, 2.6) << load << " " << what;
    EXPECT_LT(fine, rod) << load << " " << what << ": softer than the beam itself";
    EXPECT_NEAR(fine, rod, power * kTooStiff / (kFinest * kFinest) * rod) << load << " " << what;
    EXPECT_NEAR(limit, rod, (0.004 + strain * strain) * rod) << load << " " << what;
    EXPECT_NEAR(limit, elastica, 0.01 * elastica) << load << " " << what;
  }
};

INSTANTIATE_TEST_SUITE_P(Materials, CantileverBends,
                         ::testing::Values(MaterialModel::corotated, MaterialModel::neo_hookean));

TEST_P(CantileverBends, AsTheElasticaUnderATipLoad)
{
  const std::vector<Published> loads = {kTipLoads[2], kTipLoads[4], kTipLoads[6]};
  bendAll(loads, rods(loads));
}

TEST_P(CantileverBends, AsTheHeavyElasticaUnderItsOwnWeight)
{
  const std::vector<Published> loads = {kWeights[2], kWeights[4], kWeights[6]};
  bendAll(loads, rods(loads));
}

}  // namespace
}  // namespace soft_tissue
