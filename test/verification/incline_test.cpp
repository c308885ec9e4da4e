#include <gtest/gtest.h>

#include <cstdio>

#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kAngle = 20.0 * M_PI / 180.0;
constexpr double kGravity = 9.81;
constexpr double kTimeStep = 0.01;
constexpr double kStill = 1e-7;  // m/s; a stick length, a micrometre, takes ten seconds of it

/** A block on a table, both tilted. */
class Incline : public testing::TestWithParam<Response>
{
 protected:
  /** Slides along the table at the steps' ends, m. */
  std::vector<double> slides(double friction, double duration_s)
  {
    const ScratchFolder folder;
    SceneConfig config = blockScene(folder, {5, 5, 3});
    PoseConfig table;
    table.position_m = Vec3(0.0, 0.0, -0.01);
    addTool(config, BoxShape{{1.0, 1.0, 0.02}}, table, GetParam());
    config.contacts[0].friction = friction;
    config.gravity_m_per_s2 = kGravity * Vec3(std::sin(kAngle), 0.0, -std::cos(kAngle));
    config.time_step_s = kTimeStep;
    config.solver.tolerance = 1e-6;
    config.solver.max_iterations = 60;
    Scene scene(config);
    Snapshot snapshot;
    std::vector<double> slides;
    for (int k = 0; k * kTimeStep < duration_s; ++k)
    {
      const StepReport& step = scene.step();
      EXPECT_FALSE(step.held) << "step " << k;
      unconverged_ += step.converged ? 0 : 1;
      scene.fillSnapshot(snapshot);
      double sum = 0.0;
      for (const Vec3& p : snapshot.tissues[0].positions)
      {
        sum += p.x() / static_cast<double>(snapshot.tissues[0].positions.size());
      }
      slides.push_back(sum);
    }
    return slides;
  }

  int unconverged_ = 0;
};

INSTANTIATE_TEST_SUITE_P(Responses, Incline, testing::Values(Response::point, Response::segment));

TEST_P(Incline, HoldsABlockWithFivePercentMoreFrictionThanItNeeds)
{
  const std::vector<double> slide = slides(1.05 * std::tan(kAngle), 2.0);
  const double crept = (slide.back() - slide[slide.size() / 2]) / 1.0;
  std::printf("  creeps at %.2e m/s\n", crept);
  EXPECT_LE(std::abs(crept), kStill);
  EXPECT_LE(unconverged_, 2) << "of 200 steps";
}

TEST_P(Incline, LetsItSlideWithFivePercentLessAtTheRightAcceleration)
{
  const double friction = 0.95 * std::tan(kAngle);
  const std::vector<double> slide = slides(friction, 2.0);
  // Means over half a second each: what swings in the block cancels.
  const std::size_t half = slide.size() / 4;
  const double v1 = (slide[2 * half] - slide[half]) / (half * kTimeStep);
  const double v2 = (slide[4 * half - 1] - slide[3 * half - 1]) / (half * kTimeStep);
  const double found = (v2 - v1) / ((2 * half - 1) * kTimeStep);
  const double expected = kGravity * (std::sin(kAngle) - friction * std::cos(kAngle));
  std::printf("  accelerates at %.4f m/s^2, expected %.4f\n", found, expected);
  EXPECT_NEAR(found, expected, 0.02 * expected);
  EXPECT_LE(unconverged_, 2) << "of 200 steps";
}

}  // namespace
}  // namespace soft_tissue::test
