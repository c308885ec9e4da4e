#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "soft_tissue_sim/base/parallel.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kGravity = 9.81;

Snapshot snapshotOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot;
}

/** The farthest apart that two scenes have a node of any tissue, m. */
double farthestApart(const Scene& one, const Scene& other)
{
  const Snapshot a = snapshotOf(one), b = snapshotOf(other);
  double farthest = 0.0;
  for (std::size_t k = 0; k < a.tissues.size(); ++k)
  {
    for (std::size_t i = 0; i < a.tissues[k].positions.size(); ++i)
    {
      farthest = std::max(farthest, (a.tissues[k].positions[i] - b.tissues[k].positions[i]).norm());
    }
  }
  return farthest;
}

/** Steps until so many tissues sleep. @return whether they do within 10 s */
bool stepUntilAsleep(Scene& scene, int sleepers)
{
  while (scene.time() < 10.0)
  {
    scene.step();
    const Snapshot now = snapshotOf(scene);
    const auto asleep = std::count_if(now.tissues.begin(), now.tissues.end(),
                                      [](const TissueState& tissue) { return tissue.asleep; });
    if (asleep == sleepers)
    {
      return true;
    }
  }
  return false;
}

SceneConfig neverSleeping(SceneConfig config)
{
  config.solver.sleep.reset();
  return config;
}

class Sleep : public testing::TestWithParam<Stepper>
{
 protected:
  /** Three blocks on each other, the lowest held at its bottom. */
  SceneConfig stack()
  {
    const std::string block = saved(folder_, "block.msh", makeBox({3, 3, 2}, {0.04, 0.04, 0.02}));
    SceneConfig config = tissueScene(block);
    config.gravity_m_per_s2 = Vec3(0.0, 0.0, -0.5);
    config.solver.stepper = GetParam();
    config.solver.tolerance = 1e-5;
    config.solver.sleep = SleepConfig{1e-4, 0.05, 0.2};
    config.tissues[0].material.young_modulus_pa = 2e4;
    fixBelow(config, 1e-6);
    addTissue(config, "second", block, {0.001, -0.0015, 0.0201});
    addTissue(config, "third", block, {0.002, 0.0, 0.0402});
    addPair(config, "tissue", "second", Response::segment).friction = 0.4;
    addPair(config, "second", "third", Response::segment).friction = 0.4;
    for (ContactConfig& contact : config.contacts)
    {
      contact.damping_s_per_m = 10.0;
    }
    return config;
  }

  /** A held lobe, and a ball `above` it. */
  SceneConfig lobe(double above)
  {
    SceneConfig config = lobeScene();
    fixBelow(config, 0.001);
    config.solver.stepper = GetParam();
    if (GetParam() == Stepper::implicit_euler)  // by bdf2 it would swing for long
    {
      config.gravity_m_per_s2.z() = -kGravity;
    }
    config.solver.sleep = SleepConfig{1e-4, 0.05, 0.2};
    PoseConfig start;
    start.position_m = kLobeSpot + (kLobeTop + 0.008 + above) * Vec3::UnitZ();
    addTool(config, SphereShape{0.008}, start, Response::segment);
    return config;
  }

  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Steppers, Sleep, testing::Values(Stepper::implicit_euler, Stepper::bdf2));

/** What needs the damping of implicit Euler to come to rest soon. */
class DampedSleep : public Sleep
{};
INSTANTIATE_TEST_SUITE_P(Steppers, DampedSleep, testing::Values(Stepper::implicit_euler));

TEST_P(DampedSleep, AStackCostsNothingUntilItIsHit)
{
  SceneConfig config = stack();
  config.solver.tolerance = 1e-7;  // a blow makes much of little differences
  config.solver.max_iterations = 100;
  addTissue(config, "falling", config.tissues[0].mesh.file, {0.004, 0.003, 1.06});
  addPair(config, "third", "falling", Response::segment);
  Scene scene(config), restless(neverSleeping(config));
  ASSERT_TRUE(stepUntilAsleep(scene, 3));
  std::printf("  asleep after %.2f s\n", scene.time());
  ASSERT_LT(scene.time(), 1.8) << "2 s is the other in the air";
  const Snapshot asleep = snapshotOf(scene);
  EXPECT_GT(asleep.report.contacts, 0);
  while (snapshotOf(scene).tissues[0].asleep)
  {
    const StepReport& report = scene.step();
    const Snapshot now = snapshotOf(scene);
    EXPECT_GT(now.tissues[3].evaluations, 0);
    if (now.tissues[0].asleep)
    {
      EXPECT_EQ(report.sleeping, 3);
      EXPECT_EQ(report.contacts, asleep.report.contacts);
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_EQ(now.tissues[k].evaluations, 0);
        EXPECT_EQ(now.tissues[k].positions, asleep.tissues[k].positions);
        EXPECT_TRUE(now.tissues[k].asleep) << "those that touch sleep together";
      }
    }
    ASSERT_LT(scene.time(), 2.2) << "nothing woke it";
  }
  const auto lowest = [](const TissueState& tissue) {
    double z = 1.0;
    std::for_each(tissue.positions.begin(), tissue.positions.end(),
                  [&](const Vec3& p) { z = std::min(z, p.z()); });
    return z;
  };
  EXPECT_GT(lowest(snapshotOf(scene).tissues[3]), 0.055) << "woken before it was hit";
  while (restless.time() < scene.time() - 1e-9)
  {
    restless.step();
  }
  const double apart_before = farthestApart(scene, restless);
  double apart = apart_before, hit = 0.0;
  while (scene.time() < 2.3)
  {
    scene.step();
    restless.step();
    apart = std::max(apart, farthestApart(scene, restless));
    hit = std::max(
        hit, (snapshotOf(scene).tissues[2].positions[0] - asleep.tissues[2].positions[0]).norm());
  }
  std::printf(
      "  the hit moves it by %.1f mm; %.4f mm apart from one that never sleeps before it, "
      "at most %.3f mm after\n",
      1e3 * hit, 1e3 * apart_before, 1e3 * apart);
  EXPECT_GT(hit, 5e-3);
  EXPECT_LT(apart_before, 1e-6);
  EXPECT_LT(apart, 2e-5);
}

TEST_P(Sleep, AToolWakesWhatItComesNearToAndNothingElse)
{
  SceneConfig config = lobe(0.1);
  addTissue(config, "far", config.tissues[0].mesh.file, {0.5, 0.0, 0.0});
  config.tissues.back().fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 0.001)});
  Scene scene(config), restless(neverSleeping(config));
  ASSERT_TRUE(stepUntilAsleep(scene, 2));
  while (restless.time() < scene.time() - 1e-9)
  {
    restless.step();
  }
  const Pose start = config.tools[0].initial_pose.toPose();
  double apart = 0.0, force = 0.0, off = 0.0, woken_at = 0.0;
  for (int n = 1; n <= 220; ++n)
  {
    const double down = 0.104 * std::min(1.0, n / 150.0);
    for (Scene* each : {&scene, &restless})
    {
      each->setToolTarget(0, raised(start, -down));
      each->step();
    }
    const Snapshot now = snapshotOf(scene);
    EXPECT_EQ(now.tissues[1].evaluations, 0) << n;
    if (woken_at == 0.0 && !now.tissues[0].asleep)
    {
      woken_at = 0.1 - down;
    }
    EXPECT_EQ(now.report.sleeping,
              woken_at == 0.0 || (n > 150 && now.report.sleeping == 2) ? 2 : 1);
    apart = std::max(apart, farthestApart(scene, restless));
    const double still = snapshotOf(restless).tools[0].wrench_W.force.z();
    force = std::max(force, still);
    off = std::max(off, std::abs(now.tools[0].wrench_W.force.z() - still));
  }
  std::printf("  woken at %.1f mm; %.4f mm and %.2f %% of the force off\n", 1e3 * woken_at,
              1e3 * apart, 100.0 * off / force);
  EXPECT_GT(woken_at, 0.001);
  EXPECT_LT(woken_at, 0.03);
  EXPECT_LT(apart, 5e-5);
  EXPECT_GT(force, 0.05);
  EXPECT_LT(off, 0.02 * force);
}

// Matrices without the one and without the other have as many blocks, at other places.
TEST_P(DampedSleep, EqualTissuesSleepInTurn)
{
  SceneConfig config = lobe(0.05);
  addTissue(config, "other", config.tissues[0].mesh.file, {0.5, 0.0, 0.0});
  config.tissues.back().fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 0.001)});
  addPair(config, "other", "tool", Response::segment);
  Scene scene(config), restless(neverSleeping(config));
  const Pose start = config.tools[0].initial_pose.toPose();
  int first_alone = 0, second_alone = 0;
  double apart = 0.0;
  for (int n = 0; n < 800; ++n)
  {
    Pose goal = raised(start, -0.025 * (1.0 - std::cos(0.05 * M_PI * n)) * 1.08);
    goal.translation().x() += n % 400 < 200 ? 0.0 : 0.5;
    for (Scene* each : {&scene, &restless})
    {
      each->setToolTarget(0, goal);
      each->step();
    }
    const Snapshot now = snapshotOf(scene);
    first_alone += now.tissues[0].evaluations > 0 && now.tissues[1].evaluations == 0 ? 1 : 0;
    second_alone += now.tissues[1].evaluations > 0 && now.tissues[0].evaluations == 0 ? 1 : 0;
    apart = std::max(apart, farthestApart(scene, restless));
  }
  std::printf("  alone awake for %d and %d steps, %.3f mm off\n", first_alone, second_alone,
              1e3 * apart);
  EXPECT_GT(first_alone, 20);
  EXPECT_GT(second_alone, 20);
  EXPECT_LT(apart, 1e-4);
}

TEST_P(DampedSleep, PressedTissueSleepsUnderAToolThatStandsStill)
{
  SceneConfig config = lobe(-0.001);
  Scene scene(config);
  ASSERT_TRUE(stepUntilAsleep(scene, 1));
  const double force = snapshotOf(scene).tools[0].wrench_W.force.z();
  EXPECT_GT(force, 0.0);
  scene.step();
  EXPECT_EQ(scene.step().newton_iterations, 0);
  EXPECT_TRUE(snapshotOf(scene).report.converged);
  EXPECT_EQ(snapshotOf(scene).tools[0].wrench_W.force.z(), force);
  EXPECT_GT(snapshotOf(scene).report.min_det_f, 0.0);
  scene.setToolTarget(0, raised(config.tools[0].initial_pose.toPose(), 1e-5));
  scene.step();
  EXPECT_EQ(snapshotOf(scene).report.sleeping, 0);
  EXPECT_LT(snapshotOf(scene).tools[0].wrench_W.force.z(), force);
}

TEST_P(Sleep, KeyFramesWakeTheirTissue)
{
  SceneConfig config = blockScene(folder_, {3, 3, 2});
  config.solver.stepper = GetParam();
  config.solver.sleep = SleepConfig();
  fixBelow(config, 1e-6);
  NodeMotionConfig moved;
  moved.nodes = {Vec3(-1.0, -1.0, kBlockTop - 1e-6), Vec3(1.0, 1.0, 1.0)};
  moved.motion.resize(2);
  moved.motion[0].time_s = 1.0;
  moved.motion[1].time_s = 1.2;
  moved.motion[1].pose.position_m = Vec3(0.0, 0.0, 0.004);
  config.tissues[0].keyframes = {moved};
  Scene scene(config), restless(neverSleeping(config));
  for (int n = 1; n <= 200; ++n)
  {
    const bool slept = scene.step().sleeping > 0;
    restless.step();
    EXPECT_EQ(slept, (n > 50 && n <= 100) || (slept && n > 150)) << n;
    EXPECT_LT(farthestApart(scene, restless), 1e-9) << n;
  }
}

TEST_P(Sleep, NothingSleepsInTheAir)
{
  for (const double limit : {0.1, 20.0})
  {
    SceneConfig config = blockScene(folder_, {2, 2, 1});
    config.solver.stepper = GetParam();
    config.gravity_m_per_s2.z() = -kGravity;
    config.solver.sleep = SleepConfig{0.05, limit, 0.0};
    config.tissues[0].velocity_m_per_s.z() = 20 * config.time_step_s * kGravity;
    Scene scene(config);
    bool slept = false;
    double slowest = 1.0;
    for (int n = 0; n < 40; ++n)
    {
      scene.step();
      slept = slept || snapshotOf(scene).tissues[0].asleep;
      slowest = std::min(slowest, rmsSpeed(snapshotOf(scene)));
    }
    EXPECT_EQ(slept, limit > kGravity) << "a limit on acceleration above gravity's would let it";
    EXPECT_LT(slowest, 1e-3);
  }
}

TEST_P(DampedSleep, AResetWakesAndIsAFreshStart)
{
  SceneConfig config = stack();
  Scene fresh(config), used(config);
  ASSERT_TRUE(stepUntilAsleep(used, 3));
  used.step();
  used.resetWorld();
  EXPECT_FALSE(snapshotOf(used).tissues[0].asleep);
  for (int n = 0; n < 100; ++n)
  {
    fresh.step();
    used.step();
    ASSERT_EQ(farthestApart(fresh, used), 0.0) << n;
  }
}

TEST_P(DampedSleep, HasTheSameBitsForAnyThreads)
{
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2})
  {
    setThreadCount(threads);
    Scene scene(stack());
    EXPECT_TRUE(stepUntilAsleep(scene, 3));
    hashes.push_back(scene.stateHash());
  }
  setThreadCount(1);
  EXPECT_EQ(hashes[0], hashes[1]);
}

// Who sleeps, and how long others have been quiet, decides what comes next: it is part of the
// state.
TEST_P(DampedSleep, IsInTheHash)
{
  SceneConfig config = stack();
  SceneConfig later = config;
  later.solver.sleep->after_s = 1e3;
  Scene one(config), other(later);
  EXPECT_TRUE(stepUntilAsleep(one, 3));
  while (other.time() < one.time() - 1e-9)
  {
    other.step();
  }
  EXPECT_EQ(farthestApart(one, other), 0.0);
  EXPECT_NE(one.stateHash(), other.stateHash());
}

}  // namespace
}  // namespace soft_tissue::test
