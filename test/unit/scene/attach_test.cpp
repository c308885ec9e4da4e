#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/mass_terms.h"
#include "support/forceps.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kReach = 0.004;                                 // m
constexpr double kRadius = 0.01;                                 // m
const double kWeight = 9.81 * 1000.0 * 0.06 * 0.06 * kBlockTop;  // N, of the block

/** A block and a ball that just doesn't touch the middle of its top. */
class Attach : public testing::TestWithParam<Stepper>
{
 protected:
  SceneConfig block() const
  {
    SceneConfig config = blockScene(folder_, {6, 6, 3});
    config.solver.stepper = GetParam();
    addTool(config, SphereShape{kRadius},
            {Vec3(0.0, 0.0, kBlockTop + kRadius + 1e-4), Vec3::Zero()}, Response::segment);
    return config;
  }

  SceneConfig heavyBlock() const
  {
    SceneConfig config = block();
    config.gravity_m_per_s2.z() = -9.81;
    return config;
  }

  static AttachRequest within(double reach_m)
  {
    AttachRequest request;
    request.reach_m = reach_m;
    return request;
  }

  ScratchFolder folder_;
};

TEST_P(Attach, TiesTheSurfaceNodesWithinReachAndNoOthers)
{
  Scene scene(block());
  const Vec3 centre = scene.toolPose(0).translation();
  const TissueInfo& tissue = scene.tissues()[0];
  for (const double reach : {0.0, 0.004, 0.02})
  {
    const auto expected = std::count_if(
        tissue.surface.nodes.begin(), tissue.surface.nodes.end(),
        [&](Index node) { return (tissue.rest.nodes[node] - centre).norm() - kRadius <= reach; });
    EXPECT_EQ(scene.attach(within(reach)), expected) << reach;
    EXPECT_EQ(snapshotOf(scene).tools[0].attached, expected);
    EXPECT_EQ(scene.attach(within(reach)), 0) << "tied already";
    EXPECT_EQ(scene.detach(0), expected);
  }
  EXPECT_EQ(snapshotOf(scene).tools[0].attached, 0);
}

TEST_P(Attach, HasNoForceUntilTheToolMoves)
{
  Scene scene(block());
  ASSERT_GT(scene.attach(within(kReach)), 0);
  scene.step();
  EXPECT_EQ(snapshotOf(scene).tools[0].wrench_W.force, Vec3::Zero());
  scene.setToolTarget(0, raised(scene.toolPose(0), 1e-4));
  scene.step();
  EXPECT_LT(snapshotOf(scene).tools[0].wrench_W.force.z(), 0.0);
}

TEST_P(Attach, CarriesTheWeightWithItsMoment)
{
  SceneConfig config = heavyBlock();
  config.tools[0].initial_pose.position_m.x() = 0.01;
  config.tissues[0].material.young_modulus_pa = 2e5;
  config.tissues[0].material.mass_damping_per_s = 5.0;
  Scene scene(config);
  ASSERT_GT(scene.attach(within(0.012)), 2);
  for (int n = 0; n < 600; ++n)
  {
    scene.step();
  }
  const Snapshot now = snapshotOf(scene);
  EXPECT_NEAR(now.tools[0].wrench_W.force.z(), -kWeight, 1e-3 * kWeight);
  EXPECT_LT(now.tools[0].wrench_W.force.head<2>().norm(), 1e-3 * kWeight);
  Vec3 first = Vec3::Zero();
  double mass = 0.0;
  std::vector<double> masses(now.tissues[0].positions.size(), 0.0);
  addLumpedMasses(scene.tissues()[0].rest,
                  std::vector<double>(scene.tissues()[0].rest.tets.size(), 1000.0), 0, masses);
  for (std::size_t i = 0; i < masses.size(); ++i)
  {
    mass += masses[i];
    first += masses[i] * now.tissues[0].positions[i];
  }
  const Vec3 arm = first / mass - now.tools[0].X_WT.translation();
  const Vec3 expected = arm.cross(Vec3(0.0, 0.0, -kWeight));
  EXPECT_LT((now.tools[0].wrench_W.torque - expected).norm(), 2e-3 * kWeight * 0.03);
}

TEST_P(Attach, DetachedTissueFeelsNothingMoreAndFalls)
{
  Scene scene(heavyBlock());
  const int tied = scene.attach(within(kReach));
  for (int n = 0; n < 30; ++n)
  {
    scene.setToolTarget(0, raised(scene.toolPose(0), 2e-4));
    scene.step();
  }
  EXPECT_LT(snapshotOf(scene).tools[0].wrench_W.force.z(), -0.1 * kWeight);
  // Away, so that nothing but the springs is there.
  EXPECT_EQ(scene.detach(0), tied);
  scene.setToolTarget(0, raised(scene.toolPose(0), 0.05));
  scene.step();
  const Snapshot a = snapshotOf(scene);
  EXPECT_EQ(a.tools[0].wrench_W.force, Vec3::Zero());
  EXPECT_TRUE(a.tools[0].contacts.empty());
  scene.step();
  const Snapshot b = snapshotOf(scene);
  scene.step();
  const Snapshot c = snapshotOf(scene);
  const TissueInfo& tissue = scene.tissues()[0];
  std::vector<double> masses(tissue.rest.nodes.size(), 0.0);
  addLumpedMasses(tissue.rest, std::vector<double>(tissue.rest.tets.size(), 1000.0), 0, masses);
  Vec3 gain = Vec3::Zero();
  double mass = 0.0;
  for (std::size_t i = 0; i < masses.size(); ++i)
  {
    gain += masses[i] * (c.tissues[0].velocities[i] - b.tissues[0].velocities[i]);
    mass += masses[i];
  }
  const double h = scene.config().time_step_s;
  EXPECT_NEAR(gain.z() / mass / h, -9.81, 1e-6);
}

TEST_P(Attach, IsPartOfTheStateHash)
{
  Scene scene(block());
  const std::uint64_t free = scene.stateHash();
  scene.attach(within(kReach));
  const std::uint64_t tied = scene.stateHash();
  EXPECT_NE(tied, free);
  scene.detach(0);
  EXPECT_EQ(scene.stateHash(), free);
  AttachRequest soft = within(kReach);
  soft.stiffness_pa_per_m = 1e5;
  scene.attach(soft);
  EXPECT_NE(scene.stateHash(), tied);
  scene.resetWorld();
  EXPECT_EQ(snapshotOf(scene).tools[0].attached, 0);
  EXPECT_EQ(scene.stateHash(), free);
}

TEST_P(Attach, SameBitsForAnyNumberOfThreads)
{
  std::uint64_t hash[2] = {};
  for (int threads = 1; threads <= 2; ++threads)
  {
    setThreadCount(threads);
    Scene scene(heavyBlock());
    scene.attach(within(kReach));
    for (int n = 0; n < 10; ++n)
    {
      scene.setToolTarget(0, raised(scene.toolPose(0), 2e-4));
      scene.step();
    }
    hash[threads - 1] = scene.stateHash();
  }
  setThreadCount(1);
  EXPECT_EQ(hash[0], hash[1]);
}

TEST_P(Attach, FixedNodesAndOtherTissuesAreLeftAlone)
{
  SceneConfig config = block();
  fixBelow(config, 1.0);
  const std::string second = saved(folder_, "second.msh", makeBox({2, 2, 1}, {0.02, 0.02, 0.01}));
  addTissue(config, "second", second, Vec3(-0.01, -0.01, kBlockTop + 2.0 * kRadius + 2e-3));
  Scene scene(config);
  AttachRequest request = within(0.005);
  request.tissue = 0;
  EXPECT_EQ(scene.attach(request), 0) << "all are fixed";
  request.tissue = 1;
  EXPECT_GT(scene.attach(request), 0);
}

TEST_P(Attach, OnePartAloneMayHoldAndLetGo)
{
  SceneConfig config = block();
  config.tools.clear();
  config.contacts.clear();
  addForceps(config, Vec3(0.0, 0.0, 0.5 * kBlockTop), 0.0);
  Scene scene(config);
  AttachRequest request = within(0.003);
  request.part = 1;
  const int right = scene.attach(request);
  EXPECT_GT(right, 0);
  request.part.reset();
  const int left = scene.attach(request);
  EXPECT_EQ(left, right) << "each node goes to the part it is nearest to";
  EXPECT_EQ(scene.detach(0, 0), left);
  EXPECT_EQ(snapshotOf(scene).tools[0].attached, right);
  scene.setJointTargets(0, closedBy(0.0005));
  scene.step();
  const ToolState tool = snapshotOf(scene).tools[0];
  const auto tied =
      std::count_if(tool.contacts.begin(), tool.contacts.end(),
                    [](const ContactPoint& p) { return p.area == 0.0 && p.part == 1; });
  EXPECT_GE(tied, right);
}

TEST_P(Attach, SleepingTissueWakesWhenItIsTiedPulledAndLetGo)
{
  SceneConfig config = block();
  config.solver.sleep = SleepConfig();
  config.tissues[0].material.mass_damping_per_s = 10.0;
  Scene scene(config);
  const auto sleep = [&] {
    for (int n = 0; n < 1000 && snapshotOf(scene).report.sleeping == 0; ++n)
    {
      scene.step();
    }
    return snapshotOf(scene).report.sleeping == 1;
  };
  ASSERT_TRUE(sleep());
  ASSERT_GT(scene.attach(within(kReach)), 0);
  EXPECT_EQ(scene.step().sleeping, 0);
  ASSERT_TRUE(sleep());
  scene.setToolTarget(0, raised(scene.toolPose(0), 1e-4));
  EXPECT_EQ(scene.step().sleeping, 0);
  ASSERT_TRUE(sleep());
  ASSERT_GT(scene.detach(0), 0);
  EXPECT_EQ(scene.step().sleeping, 0);
}

TEST_P(Attach, RefusesWhatIsNotThere)
{
  Scene scene(block());
  EXPECT_THROW(scene.attach(within(-1.0)), Error);
  EXPECT_THROW(scene.attach(within(std::nan(""))), Error);
  EXPECT_THROW(scene.attach(within(std::numeric_limits<double>::infinity())), Error);
  AttachRequest request = within(kReach);
  for (const double stiffness : {0.0, 0.5, -1.0, 2e15, 1e308, std::nan("")})
  {
    request.stiffness_pa_per_m = stiffness;
    EXPECT_THROW(scene.attach(request), Error) << stiffness;
  }
  request = within(kReach);
  request.part = 1;
  EXPECT_THROW(scene.attach(request), Error);
  request = within(kReach);
  request.tissue = 1;
  EXPECT_THROW(scene.attach(request), Error);
  request = within(kReach);
  request.tool = 1;
  EXPECT_THROW(scene.attach(request), Error);
  EXPECT_THROW(scene.detach(1), Error);
  EXPECT_THROW(scene.detach(0, 1), Error);
}

INSTANTIATE_TEST_SUITE_P(Steppers, Attach, testing::Values(Stepper::implicit_euler, Stepper::bdf2));

}  // namespace
}  // namespace soft_tissue::test
