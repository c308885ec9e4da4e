#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/base/parallel.h"
#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kRadius = 0.008;  // m

/** A lobe under gravity, fixed at its bottom, with a ball half a millimetre above it. */
SceneConfig lobeUnderBall()
{
  SceneConfig config = lobeScene();
  fixBelow(config, 0.001);
  config.gravity_m_per_s2.z() = -9.81;
  PoseConfig start;
  start.position_m = kLobeSpot + (kLobeTop + kRadius + 0.0005) * Vec3::UnitZ();
  addTool(config, SphereShape{kRadius}, start, Response::segment);
  return config;
}

Pose startOf(const Scene& scene)
{
  return scene.config().tools[0].initial_pose.toPose();
}

/** Presses the ball 4 mm down within 40 steps and rubs it to and fro. */
void press(Scene& scene, int step)
{
  Pose goal = raised(startOf(scene), -0.0045 * std::min(1.0, step / 40.0));
  goal.translation().x() += 0.002 * std::sin(0.1 * step);
  scene.setToolTarget(0, goal);
  scene.step();
}

Snapshot snapshotOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot;
}

TEST(SceneStep, MovesTheClockByOneTimeStep)
{
  Scene scene(lobeUnderBall());
  EXPECT_EQ(scene.time(), 0.0);
  for (int n = 1; n <= 100; ++n)
  {
    const StepReport& report = scene.step();
    EXPECT_EQ(report.step, static_cast<std::uint64_t>(n));
    EXPECT_NEAR(report.time_s, 0.01 * n, 1e-12);
    EXPECT_EQ(scene.time(), report.time_s);
  }
}

TEST(SceneStep, TakesTheToolToItsTarget)
{
  Scene scene(lobeUnderBall());
  Pose goal = raised(startOf(scene), 0.01);
  goal.linear() = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  scene.setToolTarget(0, goal);
  EXPECT_TRUE(snapshotOf(scene).tools[0].X_WT.isApprox(startOf(scene), 0.0)) << "before the step";
  scene.step();
  EXPECT_TRUE(snapshotOf(scene).tools[0].X_WT.isApprox(goal, 0.0));
  scene.step();
  EXPECT_TRUE(snapshotOf(scene).tools[0].X_WT.isApprox(goal, 0.0)) << "no new target";
}

TEST(SceneStep, KeyFramedToolsFollowTheClockAndNothingElse)
{
  SceneConfig config = lobeUnderBall();
  PoseKeyframe first, last;
  first.pose = config.tools[0].initial_pose;
  last.time_s = 0.1;
  last.pose = first.pose;
  last.pose.position_m.z() += 0.02;
  config.tools[0].pose_source.kind = PoseSourceConfig::Kind::keyframes;
  config.tools[0].pose_source.keyframes = {first, last};
  Scene scene(config);
  for (int n = 1; n <= 15; ++n)
  {
    scene.setToolTarget(0, raised(startOf(scene), -0.02));
    scene.step();
    const double raise = 0.02 * std::min(1.0, n / 10.0);
    EXPECT_NEAR(snapshotOf(scene).tools[0].X_WT.translation().z(),
                first.pose.position_m.z() + raise, 1e-12);
  }
}

TEST(SceneStep, ReadingOutChangesNothing)
{
  Scene scene(lobeUnderBall()), silent(lobeUnderBall());
  Snapshot snapshot;
  for (int n = 1; n <= 50; ++n)
  {
    press(scene, n);
    press(silent, n);
    const std::uint64_t hash = scene.stateHash();
    scene.fillSnapshot(snapshot);
    EXPECT_EQ(snapshot.state_hash, hash);
    EXPECT_EQ(scene.stateHash(), hash);
    ASSERT_EQ(silent.stateHash(), hash) << "step " << n;
  }
}

TEST(SceneStep, SnapshotHoldsTheWholeState)
{
  for (const bool stress : {false, true})
  {
    SceneConfig config = lobeUnderBall();
    config.outputs.stress = stress;
    Scene scene(config);
    const TissueInfo& info = scene.tissues()[0];
    const Snapshot before = snapshotOf(scene);
    EXPECT_EQ(before.tissues[0].positions, info.rest.nodes);
    EXPECT_EQ(before.report.step, 0u);
    EXPECT_TRUE(before.tools[0].contacts.empty());
    EXPECT_EQ(before.tools[0].wrench_W.force, Vec3::Zero());
    Snapshot last;
    for (int n = 1; n <= 40; ++n)
    {
      last = snapshotOf(scene);
      press(scene, n);
    }
    const Snapshot now = snapshotOf(scene);
    ASSERT_EQ(now.tissues.size(), 1u);
    ASSERT_EQ(now.tools.size(), 1u);
    EXPECT_EQ(now.report.step, 40u);
    EXPECT_EQ(now.tissues[0].positions.size(), info.rest.nodes.size());
    EXPECT_EQ(now.tissues[0].von_mises.size(), stress ? info.rest.tets.size() : 0u);
    EXPECT_GT(now.report.contacts, 0);
    EXPECT_EQ(now.tools[0].contacts.size(), static_cast<std::size_t>(now.report.contacts));
    EXPECT_GT(now.report.max_penetration_m, 0.0);
    EXPECT_GT(now.report.min_det_f, 0.0);
    EXPECT_LT(now.report.min_det_f, 1.0);
    EXPECT_GT(now.report.ms.total, 0.0);
    for (std::size_t i = 0; i < info.rest.nodes.size(); ++i)
    {
      const Vec3 v =
          (now.tissues[0].positions[i] - last.tissues[0].positions[i]) / config.time_step_s;
      EXPECT_LT((now.tissues[0].velocities[i] - v).norm(), 1e-12);
    }
    for (const Index node : info.fixed_nodes)
    {
      EXPECT_EQ(now.tissues[0].positions[node], info.rest.nodes[node]);
      EXPECT_EQ(now.tissues[0].velocities[node], Vec3::Zero());
    }
  }
}

TEST(SceneReset, GoesBackToTheStartButNotInTime)
{
  Scene scene(lobeUnderBall());
  const Snapshot fresh = snapshotOf(scene);
  for (int n = 1; n <= 60; ++n)
  {
    press(scene, n);
  }
  ASSERT_NE(snapshotOf(scene).tissues[0].positions, fresh.tissues[0].positions);
  scene.resetWorld();
  const Snapshot reset = snapshotOf(scene);
  EXPECT_EQ(reset.tissues[0].positions, fresh.tissues[0].positions);
  EXPECT_EQ(reset.tissues[0].velocities, fresh.tissues[0].velocities);
  EXPECT_TRUE(reset.tools[0].X_WT.isApprox(fresh.tools[0].X_WT, 0.0));
  EXPECT_TRUE(reset.tools[0].contacts.empty());
  EXPECT_EQ(reset.tools[0].wrench_W.force, Vec3::Zero());
  EXPECT_EQ(reset.report.step, 60u);
  EXPECT_NEAR(scene.time(), 0.6, 1e-12);
}

TEST(SceneReset, WhatFollowsIsWhatFollowsAFreshStart)
{
  Scene fresh(lobeUnderBall()), used(lobeUnderBall());
  for (int n = 1; n <= 60; ++n)
  {
    press(used, n);
  }
  used.resetWorld();
  for (int n = 1; n <= 60; ++n)
  {
    press(fresh, n);
    press(used, n);
    const Snapshot a = snapshotOf(fresh), b = snapshotOf(used);
    ASSERT_EQ(a.tissues[0].positions, b.tissues[0].positions) << "step " << n;
    ASSERT_EQ(a.tissues[0].velocities, b.tissues[0].velocities) << "step " << n;
    ASSERT_EQ(a.tools[0].wrench_W.force, b.tools[0].wrench_W.force) << "step " << n;
  }
}

TEST(SceneStep, HasTheSameBitsForAnyThreadsAndEveryTime)
{
  std::vector<std::vector<std::uint64_t>> runs;
  for (const int threads : {1, 2, 1, 2})
  {
    setThreadCount(threads);
    Scene scene(lobeUnderBall());
    runs.emplace_back();
    int touching = 0;
    for (int n = 1; n <= 100; ++n)
    {
      press(scene, n);
      runs.back().push_back(scene.stateHash());
      touching += snapshotOf(scene).report.contacts > 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 60);
  }
  setThreadCount(1);
  for (const std::vector<std::uint64_t>& run : runs)
  {
    EXPECT_EQ(run, runs[0]);
  }
  for (std::size_t n = 1; n < runs[0].size(); ++n)
  {
    EXPECT_NE(runs[0][n], runs[0][n - 1]);
  }
}

TEST(Scene, MovesWithAllItHas)
{
  Scene first(lobeUnderBall()), other(lobeUnderBall());
  press(first, 20);
  press(other, 20);
  Scene second(std::move(first));
  press(second, 21);
  press(other, 21);
  EXPECT_EQ(second.stateHash(), other.stateHash());
}

}  // namespace
}  // namespace soft_tissue
