#include <gtest/gtest.h>

#include <cstdio>

#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kRadius = 0.008;  // m

struct Press
{
  double deepest = 0.0, force = 0.0, after = 0.0;  ///< m while pressed, N, m at last
  int newton_iterations = 0;
};

/** A ball that goes 4 mm into the lobe, stays, and goes back to 1 mm. */
Press press(std::optional<double> limit_m, Response response, double stiffness)
{
  SceneConfig config = lobeScene();
  fixBelow(config, 0.001);
  PoseConfig start;
  start.position_m = kLobeSpot + (kLobeTop + kRadius + 0.0005) * Vec3::UnitZ();
  addTool(config, SphereShape{kRadius}, start, response);
  config.contacts[0].stiffness_pa_per_m = stiffness;
  config.contacts[0].max_penetration_m = limit_m;
  Scene scene(config);
  Press result;
  Snapshot snapshot;
  for (int n = 1; n <= 300; ++n)
  {
    const double down = n <= 40 ? 0.0045 * n / 40 : n <= 60 ? 0.0045 : 0.0015;
    scene.setToolTarget(0, raised(start.toPose(), -down));
    const StepReport& report = scene.step();
    EXPECT_TRUE(report.converged) << n;
    EXPECT_FALSE(report.held) << n;
    result.newton_iterations += report.newton_iterations;
    result.deepest = std::max(result.deepest, report.max_penetration_m);
    result.after = report.max_penetration_m;
    if (n == 60)
    {
      scene.fillSnapshot(snapshot);
      result.force = snapshot.tools[0].wrench_W.force.norm();
    }
  }
  std::printf("  deepest %.4f mm, %.4f N, at last %.4f mm, %d Newton iterations\n",
              1e3 * result.deepest, result.force, 1e3 * result.after, result.newton_iterations);
  return result;
}

class PenetrationLimit : public testing::TestWithParam<Response>
{};

INSTANTIATE_TEST_SUITE_P(Responses, PenetrationLimit,
                         testing::Values(Response::point, Response::segment));

TEST_P(PenetrationLimit, IsKeptInEveryStepAndGivesTheForceOfAStifferContact)
{
  constexpr double kSoft = 1e6, kLimit = 5e-5;
  const Press soft = press(std::nullopt, GetParam(), kSoft);
  const Press limited = press(kLimit, GetParam(), kSoft);
  const Press stiff = press(std::nullopt, GetParam(), 1000.0 * kSoft);
  EXPECT_GT(soft.deepest, 10.0 * kLimit);
  EXPECT_LE(limited.deepest, kLimit);
  EXPECT_NEAR(limited.force, stiff.force, 0.05 * stiff.force);
  EXPECT_LT(soft.force, 0.9 * stiff.force);
}

}  // namespace
}  // namespace soft_tissue::test
