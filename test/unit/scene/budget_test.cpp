#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kRadius = 0.01;      // m
constexpr double kNoTime = 1e-6;      // ms: no step is done in it
constexpr double kAllTime = 60000.0;  // ms

SceneConfig lobeUnderBall(std::optional<double> budget_ms)
{
  SceneConfig config = lobeScene();
  config.solver.budget_ms = budget_ms;
  config.solver.tolerance = 1e-4;
  fixBelow(config, 0.001);
  PoseConfig start;
  start.position_m = kLobeSpot + (kLobeTop + kRadius + 0.0005) * Vec3::UnitZ();
  addTool(config, SphereShape{kRadius}, start, Response::segment);
  return config;
}

/** Presses the ball 6 mm deep within 30 steps, and leaves it there. */
void press(Scene& scene, int step)
{
  const Pose start = scene.config().tools[0].initial_pose.toPose();
  scene.setToolTarget(0, raised(start, -0.0065 * std::min(1.0, step / 30.0)));
  scene.step();
}

Snapshot snapshotOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot;
}

TEST(StepBudget, ChangesNothingWhereThereIsTimeEnough)
{
  Scene free(lobeUnderBall(std::nullopt)), bound(lobeUnderBall(kAllTime));
  for (int step = 1; step <= 40; ++step)
  {
    press(free, step);
    press(bound, step);
    EXPECT_EQ(free.stateHash(), bound.stateHash());
    EXPECT_FALSE(snapshotOf(bound).report.out_of_time);
  }
}

TEST(StepBudget, StepsWithoutTimeSayHowFarTheyAreAndComeToTheSameEnd)
{
  Scene free(lobeUnderBall(std::nullopt)), hurried(lobeUnderBall(kNoTime));
  int out_of_time = 0;
  double most_error = 0.0;
  for (int step = 1; step <= 400; ++step)
  {
    press(free, step);
    press(hurried, step);
    const StepReport report = snapshotOf(hurried).report;
    EXPECT_FALSE(report.held);
    EXPECT_EQ(report.halvings, 0) << "a step that is out of time has not failed";
    EXPECT_LE(report.newton_iterations, 1);
    EXPECT_GT(report.min_det_f, 0.0);
    EXPECT_EQ(report.out_of_time, !report.converged);
    out_of_time += report.out_of_time ? 1 : 0;
    if (report.out_of_time)
    {
      EXPECT_GT(report.residual, 1e-4);
      most_error = std::max(most_error, report.position_error_m);
    }
  }
  EXPECT_GT(out_of_time, 10);
  EXPECT_GT(most_error, 1e-6);
  const Snapshot at_leisure = snapshotOf(free), in_a_hurry = snapshotOf(hurried);
  const double force = at_leisure.tools[0].wrench_W.force.z();
  EXPECT_GT(force, 0.1);
  EXPECT_NEAR(in_a_hurry.tools[0].wrench_W.force.z(), force, 2e-3 * force);
  for (std::size_t i = 0; i < at_leisure.tissues[0].positions.size(); ++i)
  {
    const Vec3 off = in_a_hurry.tissues[0].positions[i] - at_leisure.tissues[0].positions[i];
    EXPECT_LT(off.norm(), 2e-5);
  }
}

// Halving a step that failed takes up to 16 times as long, and what is late already gets later.
TEST(StepBudget, AStepThatFailsWithoutTimeIsNotHalved)
{
  SceneConfig config = lobeUnderBall(kNoTime);
  config.solver.max_iterations = 1;  // ends without having asked for the time
  config.time_step_s = 0.05;
  config.contacts[0].stiffness_pa_per_m = 1e8;
  SceneConfig patient = config;
  patient.solver.budget_ms.reset();
  Scene scene(config), other(patient);
  const Pose start = config.tools[0].initial_pose.toPose();
  int halvings = 0;
  double fastest = 0.0;
  for (int step = 0; step < 40; ++step)
  {
    const Pose goal = raised(start, step < 3 ? -0.004 * step : 0.02);
    scene.setToolTarget(0, goal);
    other.setToolTarget(0, goal);
    const StepReport& report = scene.step();
    EXPECT_EQ(report.halvings, 0) << step;
    EXPECT_FALSE(report.held) << step;
    EXPECT_LE(report.newton_iterations, report.parts) << step;
    EXPECT_EQ(report.out_of_time, report.residual > 0.05 && !report.converged) << step;
    halvings += other.step().halvings;
    const Snapshot now = snapshotOf(scene);
    double speed = 0.0;
    for (const Vec3& v : now.tissues[0].velocities)
    {
      ASSERT_TRUE(v.allFinite()) << step;
      speed = std::max(speed, v.norm());
    }
    fastest = step < 10 ? std::max(fastest, speed) : fastest;
    EXPECT_LE(speed, fastest) << step;
  }
  EXPECT_GT(halvings, 0) << "it would be halved if there was time";
}

// However little time, each part of a step that a fast tool needs does something, and no part's end
// is hidden by a better one after it.
TEST(StepBudget, StepsInPartsWithoutTimeDoOneIterationInEachAndTellTheWorst)
{
  Scene free(lobeUnderBall(std::nullopt)), hurried(lobeUnderBall(kNoTime));
  const Pose start = free.config().tools[0].initial_pose.toPose();
  int most_parts = 1;
  for (int step = 0; step < 300; ++step)
  {
    const Pose goal = raised(start, step == 0 ? 0.06 : -0.0065);  // all the way down in one step
    for (Scene* scene : {&free, &hurried})
    {
      scene->setToolTarget(0, goal);
      scene->step();
    }
    const StepReport report = snapshotOf(hurried).report;
    EXPECT_LE(report.newton_iterations, report.parts) << step;
    EXPECT_EQ(report.halvings, 0) << step;
    EXPECT_FALSE(report.held) << step;
    EXPECT_EQ(report.out_of_time, !report.converged) << step;
    if (report.parts > 1)
    {
      most_parts = report.parts;
      EXPECT_TRUE(report.out_of_time);
    }
  }
  EXPECT_GE(most_parts, 2);
  const double force = snapshotOf(free).tools[0].wrench_W.force.z();
  EXPECT_GT(force, 0.1);
  // Where edges enter and leave contact, other iterates end in slightly other states.
  EXPECT_NEAR(snapshotOf(hurried).tools[0].wrench_W.force.z(), force, 1e-2 * force);
}

class HurriedSteps : public ::testing::TestWithParam<Stepper>
{};

INSTANTIATE_TEST_SUITE_P(Steppers, HurriedSteps,
                         ::testing::Values(Stepper::implicit_euler, Stepper::bdf2));

TEST_P(HurriedSteps, AddNoEnergy)
{
  SceneConfig config = lobeUnderBall(kNoTime);
  config.solver.stepper = GetParam();
  Scene scene(config);
  for (int step = 1; step <= 40; ++step)
  {
    press(scene, step);
  }
  // The ball is gone at once; what the tissue does from there comes from itself.
  scene.setToolTarget(0, raised(scene.config().tools[0].initial_pose.toPose(), 0.05));
  scene.step();
  const auto speed = [&] {
    const Snapshot now = snapshotOf(scene);
    double squared = 0.0;
    for (const Vec3& v : now.tissues[0].velocities)
    {
      squared += v.squaredNorm();
    }
    return std::sqrt(squared / static_cast<double>(now.tissues[0].velocities.size()));
  };
  double fastest = 0.0;
  for (int step = 0; step < 20; ++step)
  {
    scene.step();
    fastest = std::max(fastest, speed());
  }
  for (int step = 0; step < 300; ++step)
  {
    scene.step();
    EXPECT_LE(speed(), fastest);
  }
  EXPECT_LT(speed(), 1e-3 * fastest);
}

}  // namespace
}  // namespace soft_tissue
