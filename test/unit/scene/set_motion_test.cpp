#include <gtest/gtest.h>

#include <limits>

#include "soft_tissue_sim/base/error.h"
#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
SceneConfig twoBlocks(const ScratchFolder& folder)
{
  SceneConfig config = blockScene(folder, {2, 2, 1});
  config.tissues.push_back(config.tissues[0]);
  config.tissues[1].name = "other";
  config.tissues[1].pose.position_m.x() += 1.0;
  return config;
}
}  // namespace

TEST(SetMotion, PutsOneTissueWhereItIsToldToBe)
{
  const ScratchFolder folder;
  Scene scene(twoBlocks(folder));
  const Points rest = scene.tissues()[1].rest.nodes;
  const Vec3 shift(0.0, 0.1, 0.0), speed(0.0, 0.0, 2.0);
  Points x = rest;
  for (Vec3& p : x)
  {
    p += shift;
  }
  scene.step();
  scene.setMotion(1, x, Points(x.size(), speed));
  scene.step();
  Snapshot state;
  scene.fillSnapshot(state);
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    const Vec3 expected = rest[i] + shift + scene.config().time_step_s * speed;
    EXPECT_LT((state.tissues[1].positions[i] - expected).norm(), 1e-12);
    EXPECT_LT((state.tissues[0].positions[i] - scene.tissues()[0].rest.nodes[i]).norm(), 1e-12);
  }
}

// What was before must not show: the same as a scene that never moved before.
TEST(SetMotion, LeavesNothingOfThePastBehind)
{
  for (const Stepper stepper : {Stepper::implicit_euler, Stepper::bdf2})
  {
    const ScratchFolder folder;
    SceneConfig config = blockScene(folder, {2, 2, 1});
    config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    config.solver.stepper = stepper;
    fixBelow(config, 1e-6);
    Scene moved(config), fresh(config);
    const Points& rest = moved.tissues()[0].rest.nodes;
    const Points still(rest.size(), Vec3::Zero());
    for (int step = 0; step < 5; ++step)
    {
      moved.step();
    }
    moved.setMotion(0, rest, still);
    fresh.setMotion(0, rest, still);
    Snapshot one, other;
    for (int step = 0; step < 5; ++step)
    {
      moved.step();
      fresh.step();
    }
    moved.fillSnapshot(one);
    fresh.fillSnapshot(other);
    EXPECT_EQ(one.tissues[0].positions, other.tissues[0].positions);
    EXPECT_EQ(one.tissues[0].velocities, other.tissues[0].velocities);
  }
}

TEST(SetMotion, RefusesWrongCountsAndWhatIsNotFinite)
{
  const ScratchFolder folder;
  Scene scene(blockScene(folder, {2, 2, 1}));
  const std::uint64_t hash = scene.stateHash();
  const Points x = scene.tissues()[0].rest.nodes;
  Points spoilt = x;
  spoilt[3].y() = std::numeric_limits<double>::infinity();
  const Points still(x.size(), Vec3::Zero());
  EXPECT_THROW(scene.setMotion(0, x, Points(2)), Error);
  EXPECT_THROW(scene.setMotion(0, Points(), still), Error);
  EXPECT_THROW(scene.setMotion(0, spoilt, still), Error);
  EXPECT_THROW(scene.setMotion(0, x, spoilt), Error);
  EXPECT_EQ(scene.stateHash(), hash);
}
}  // namespace soft_tissue::test
