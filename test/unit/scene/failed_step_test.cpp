#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kRadius = 0.01;  // m

/** A fixed block, and a hard ball that a step may push far into it. */
SceneConfig blockUnderBall(const ScratchFolder& folder, int max_iterations,
                           Stepper stepper = Stepper::implicit_euler)
{
  SceneConfig config = blockScene(folder, {6, 6, 3});
  config.time_step_s = 0.05;
  config.solver.stepper = stepper;
  fixBelow(config, 0.001);
  config.gravity_m_per_s2.z() = -9.81;
  config.solver.max_iterations = max_iterations;
  PoseConfig start;
  start.position_m = Vec3(0.001, 0.002, kBlockTop + kRadius + 0.0005);
  addTool(config, SphereShape{kRadius}, start, Response::segment);
  config.contacts[0].stiffness_pa_per_m = 1e8;
  return config;
}

Snapshot snapshotOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot;
}

bool allFinite(const Points& points)
{
  return std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); });
}

/** Few iterations are enough for gravity, one is not for a ball that jumps 2 cm deep. */
class FailedStep : public ::testing::TestWithParam<Stepper>
{
 protected:
  static constexpr double kJump = 0.02;  // m
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(All, FailedStep,
                         ::testing::Values(Stepper::implicit_euler, Stepper::bdf2,
                                           Stepper::quasi_static));

TEST_P(FailedStep, HoldsTheLastGoodStateAndSaysSo)
{
  Scene scene(blockUnderBall(folder_, 1, GetParam()));
  for (int n = 0; n < 5; ++n)
  {
    ASSERT_FALSE(scene.step().held);
  }
  const Snapshot good = snapshotOf(scene);
  scene.setToolTarget(0, raised(good.tools[0].X_WT, -kJump));
  const StepReport& report = scene.step();
  ASSERT_TRUE(report.held) << "residual " << report.residual;
  EXPECT_FALSE(report.converged);
  EXPECT_GT(report.residual, 0.05);
  EXPECT_GT(report.halvings, 0);
  EXPECT_EQ(report.step, 6u);
  EXPECT_NEAR(scene.time(), 0.3, 1e-12);
  const Snapshot held = snapshotOf(scene);
  EXPECT_EQ(held.tissues[0].positions, good.tissues[0].positions);
  for (const Vec3& v : held.tissues[0].velocities)
  {
    EXPECT_EQ(v, Vec3::Zero());
  }
}

TEST_P(FailedStep, IsNotTheEnd)
{
  Scene scene(blockUnderBall(folder_, 1, GetParam()));
  scene.step();
  const Pose up = snapshotOf(scene).tools[0].X_WT;
  scene.setToolTarget(0, raised(up, -kJump));
  ASSERT_TRUE(scene.step().held);
  scene.setToolTarget(0, up);
  for (int n = 0; n < 20; ++n)
  {
    EXPECT_FALSE(scene.step().held) << n;
    EXPECT_TRUE(allFinite(snapshotOf(scene).tissues[0].positions));
  }
}

TEST_P(FailedStep, IsHalvedFirst)
{
  Scene scene(blockUnderBall(folder_, 4, GetParam()));
  scene.step();
  const Pose goal = raised(snapshotOf(scene).tools[0].X_WT, -0.75 * kJump);
  scene.setToolTarget(0, goal);
  const StepReport& report = scene.step();
  EXPECT_GT(report.halvings, 0);
  EXPECT_FALSE(report.held) << "residual " << report.residual;
  EXPECT_EQ(report.step, 2u);
  EXPECT_NEAR(scene.time(), 0.1, 1e-12);
  const Snapshot snapshot = snapshotOf(scene);
  EXPECT_TRUE(snapshot.tools[0].X_WT.isApprox(goal, 0.0));
  EXPECT_GT(snapshot.tools[0].wrench_W.force.z(), 0.0);
  EXPECT_GT(snapshot.report.min_det_f, 0.0);
}

// Whatever the tool does: what comes out are numbers.
TEST_P(FailedStep, NeverLetsOutWhatIsNotANumber)
{
  Scene scene(blockUnderBall(folder_, 4, GetParam()));
  const Pose start = snapshotOf(scene).tools[0].X_WT;
  const double depths[] = {0.03, -0.01, 0.05, 0.0, 1e3, -1e3, 0.02, 0.0, 0.0, 0.0};
  for (const double depth : depths)
  {
    Pose goal = raised(start, -depth);
    goal.translation().x() += 0.3 * depth;
    scene.setToolTarget(0, goal);
    const StepReport& report = scene.step();
    EXPECT_TRUE(std::isfinite(report.residual)) << depth;
    EXPECT_TRUE(std::isfinite(report.min_det_f)) << depth;
    const Snapshot snapshot = snapshotOf(scene);
    EXPECT_TRUE(allFinite(snapshot.tissues[0].positions)) << depth;
    EXPECT_TRUE(allFinite(snapshot.tissues[0].velocities)) << depth;
    EXPECT_TRUE(snapshot.tools[0].wrench_W.force.allFinite()) << depth;
    EXPECT_TRUE(snapshot.tools[0].wrench_W.torque.allFinite()) << depth;
  }
}

// At rest there is nothing to remember; what the first parts of the step pressed must not be.
TEST(FailedStep, IsNotRemembered)
{
  ScratchFolder folder;
  SceneConfig config = blockUnderBall(folder, 2, Stepper::quasi_static);
  config.gravity_m_per_s2.setZero();
  config.tissues[0].material.relaxation = {{2.0, 1.0}};
  Scene scene(config);
  const Points rest = scene.tissues()[0].rest.nodes;
  const Pose up = snapshotOf(scene).tools[0].X_WT;
  scene.setToolTarget(0, raised(up, -0.05));  // through the held bottom
  ASSERT_TRUE(scene.step().held);
  scene.setToolTarget(0, up);
  for (int n = 0; n < 3; ++n)
  {
    ASSERT_FALSE(scene.step().held);
    const Snapshot snapshot = snapshotOf(scene);
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      ASSERT_LT((snapshot.tissues[0].positions[i] - rest[i]).norm(), 1e-12);
    }
  }
}

// Without gravity nothing but rounding errors is left of the forces in the end.
TEST(FailedStep, IsNoneOnTheWayBackToRest)
{
  SceneConfig config = lobeScene();
  fixBelow(config, 0.001);
  PoseConfig above;
  above.position_m = kLobeSpot + Vec3(0.0, 0.0, kLobeTop + kRadius + 0.0005);
  addTool(config, SphereShape{kRadius}, above, Response::segment);
  Scene scene(config);
  const Pose start = above.toPose();
  for (int n = 1; n <= 300; ++n)
  {
    scene.setToolTarget(0, raised(start, -0.005 * std::min(1.0, std::max(0.0, 2.0 - 0.1 * n))));
    const StepReport& report = scene.step();
    ASSERT_FALSE(report.held) << n;
    ASSERT_EQ(report.halvings, 0) << n;
    ASSERT_TRUE(report.converged) << n << ": " << report.residual;
  }
}

}  // namespace
}  // namespace soft_tissue
