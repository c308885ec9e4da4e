#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "support/forceps.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kSqueeze = 0.008;  // m, of each jaw

class Jaws : public testing::Test
{
 protected:
  SceneConfig block(double friction) const
  {
    SceneConfig config = blockScene(folder_, {4, 4, 2});
    addForceps(config, Vec3(0.0, 0.0, 0.5 * kBlockTop), friction);
    return config;
  }

  ScratchFolder folder_;
};

/** Closes both jaws evenly. */
void squeeze(Scene& scene, double from, double to, int steps)
{
  for (int n = 1; n <= steps; ++n)
  {
    scene.setJointTargets(0, closedBy(from + (to - from) * n / steps));
    scene.step();
    ASSERT_FALSE(snapshotOf(scene).report.held);
  }
}

TEST_F(Jaws, PartsGoWhereTheJointsPutThem)
{
  Scene scene(block(0.0));
  ASSERT_EQ(scene.tools()[0].parts.size(), 2u);
  EXPECT_EQ(scene.tools()[0].parts[0].name, "left_jaw");
  EXPECT_EQ(scene.tools()[0].joints[1].name, "right");
  Pose X_WT = scene.toolPose(0);
  X_WT.translation() += Vec3(0.0, 0.0, 0.2);
  X_WT.rotate(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
  scene.setToolTarget(0, X_WT);
  JointValues q(2);
  q << 0.001, 0.004;
  scene.setJointTargets(0, q);
  scene.step();
  const ToolState tool = snapshotOf(scene).tools[0];
  EXPECT_EQ(tool.joints, q);
  const double x = 0.5 * (kJawOpening + kJawThickness);
  EXPECT_LT((tool.parts[0].X_WP.translation() - X_WT * Vec3(-x + 0.001, 0, 0)).norm(), 1e-15);
  EXPECT_LT((tool.parts[1].X_WP.translation() - X_WT * Vec3(x - 0.004, 0, 0)).norm(), 1e-15);
  EXPECT_TRUE(tool.parts[1].X_WP.linear().isApprox(X_WT.linear(), 1e-15));
}

TEST_F(Jaws, LimitsAndSpeedsOfJointsHold)
{
  Scene scene(block(0.0));
  scene.setToolTarget(0, raised(scene.toolPose(0), 0.2));
  JointValues far(2);
  far << 1.0, -1.0;
  scene.setJointTargets(0, far);
  for (int n = 1; n <= 6; ++n)
  {
    scene.step();
    const JointValues& q = snapshotOf(scene).tools[0].joints;
    EXPECT_NEAR(q[0], std::min(0.02, 0.5 * 0.01 * n), 1e-15) << n;
    EXPECT_EQ(q[1], 0.0);
  }
  EXPECT_THROW(scene.setJointTargets(0, JointValues::Zero(1)), Error);
  EXPECT_THROW(scene.setJointTargets(0, JointValues::Zero(3)), Error);
}

TEST_F(Jaws, TheToolIsNoFasterThanItMayBe)
{
  SceneConfig config = block(0.0);
  config.tools[0].max_speed_m_per_s = 0.3;
  config.tools[0].max_turn_rate_rad_per_s = 2.0;
  Scene scene(config);
  const Pose start = scene.toolPose(0);
  Pose far = raised(start, 0.01);
  scene.setToolTarget(0, far);
  for (int n = 1; n <= 4; ++n)
  {
    scene.step();
    EXPECT_NEAR(scene.toolPose(0).translation().z() - start.translation().z(),
                std::min(0.01, 0.003 * n), 1e-15);
  }
  far.rotate(Eigen::AngleAxisd(0.03, Vec3::UnitX()));
  scene.setToolTarget(0, far);
  scene.step();
  EXPECT_NEAR(Eigen::AngleAxisd(start.linear().transpose() * scene.toolPose(0).linear()).angle(),
              0.02, 1e-12);
  scene.step();
  EXPECT_TRUE(scene.toolPose(0).isApprox(far, 0.0));
}

TEST_F(Jaws, TwoJawsAreTwoToolsThatMoveTheSame)
{
  const SceneConfig config = block(0.3);
  SceneConfig apart = config;
  apart.tools.clear();
  apart.contacts.clear();
  for (const double side : {-1.0, 1.0})
  {
    addTool(apart, config.tools[0].shapes[0].geometry, config.tools[0].initial_pose,
            Response::segment);
    apart.tools.back().name = side < 0.0 ? "left" : "right";
    apart.tools.back().initial_pose.position_m.x() = side * 0.5 * (kJawOpening + kJawThickness);
    apart.contacts.back() = config.contacts[0];
    apart.contacts.back().other = apart.tools.back().name;
  }
  Scene jaws(config), tools(apart);
  for (int n = 1; n <= 30; ++n)
  {
    const double value = kSqueeze * n / 30;
    jaws.setJointTargets(0, closedBy(value));
    jaws.step();
    for (std::size_t k = 0; k < 2; ++k)
    {
      Pose X = apart.tools[k].initial_pose.toPose();
      X.translation().x() += k == 0 ? value : -value;
      tools.setToolTarget(k, X);
    }
    tools.step();
  }
  const Snapshot a = snapshotOf(jaws), b = snapshotOf(tools);
  EXPECT_GT(a.tools[0].parts[0].wrench_W.force.norm(), 0.1);
  for (std::size_t k = 0; k < 2; ++k)
  {
    const Vec3& one = a.tools[0].parts[k].wrench_W.force;
    const Vec3& other = b.tools[k].wrench_W.force;
    EXPECT_LT((one - other).norm(), 1e-6 * other.norm()) << k;
  }
  for (std::size_t i = 0; i < a.tissues[0].positions.size(); ++i)
  {
    EXPECT_LT((a.tissues[0].positions[i] - b.tissues[0].positions[i]).norm(), 1e-9);
  }
}

TEST_F(Jaws, TheWrenchIsTheSumOfItsPartsAndOfItsContacts)
{
  Scene scene(block(0.5));
  scene.setJointTargets(0, closedBy(kSqueeze));
  for (int n = 0; n < 20; ++n)
  {
    scene.setToolTarget(0, raised(scene.toolPose(0), 1e-4));
    scene.step();
  }
  const ToolState tool = snapshotOf(scene).tools[0];
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  Vec3 of_part[2] = {Vec3::Zero(), Vec3::Zero()};
  for (const ContactPoint& point : tool.contacts)
  {
    ASSERT_TRUE(point.part == 0 || point.part == 1);
    EXPECT_GT(point.part == 0 ? -point.position_W.x() : point.position_W.x(), 0.0);
    force += point.force_W;
    torque += (point.position_W - tool.X_WT.translation()).cross(point.force_W);
    of_part[point.part] += point.force_W;
  }
  EXPECT_LT((tool.wrench_W.force - force).norm(), 1e-12);
  EXPECT_LT((tool.wrench_W.torque - torque).norm(), 1e-12);
  EXPECT_LT((tool.parts[0].wrench_W.force - of_part[0]).norm(), 1e-12);
  EXPECT_LT((tool.parts[1].wrench_W.force - of_part[1]).norm(), 1e-12);
  EXPECT_LT(of_part[0].x(), -0.1);
  EXPECT_GT(of_part[1].x(), 0.1);
}

TEST_F(Jaws, CloseLiftAndLetGo)
{
  SceneConfig config = block(1.0);
  config.gravity_m_per_s2.z() = -1.0;
  config.tissues[0].material.mass_damping_per_s = 20.0;
  Scene scene(config);
  squeeze(scene, 0.0, kSqueeze, 10);
  const double weight = 1000.0 * 0.06 * 0.06 * kBlockTop;  // N, at 1 m/s^2
  const double held_z = centreOf(snapshotOf(scene).tissues[0]).z();
  for (int n = 1; n <= 40; ++n)
  {
    scene.setToolTarget(0, raised(scene.toolPose(0), 5e-4));
    scene.step();
  }
  for (int n = 0; n < 40; ++n)
  {
    scene.step();
  }
  Snapshot now = snapshotOf(scene);
  EXPECT_NEAR(centreOf(now.tissues[0]).z() - held_z, 0.02, 0.002) << "it came along";
  EXPECT_NEAR(now.tools[0].wrench_W.force.z(), -weight, 0.02 * weight) << "and is carried";
  squeeze(scene, kSqueeze, 0.0, 10);
  now = snapshotOf(scene);
  EXPECT_EQ(now.tools[0].wrench_W.force, Vec3::Zero()) << "let go";
  EXPECT_TRUE(now.tools[0].contacts.empty());
  const double before = centreOf(now.tissues[0]).z();
  scene.step();
  EXPECT_LT(centreOf(snapshotOf(scene).tissues[0]).z(), before - 1e-5) << "falling";
}

TEST_F(Jaws, WithoutFrictionTissueSlipsOut)
{
  SceneConfig config = block(0.0);
  config.gravity_m_per_s2.z() = -1.0;
  config.tissues[0].material.mass_damping_per_s = 20.0;
  Scene scene(config);
  squeeze(scene, 0.0, kSqueeze, 10);
  const double before = centreOf(snapshotOf(scene).tissues[0]).z();
  for (int n = 1; n <= 20; ++n)
  {
    scene.setToolTarget(0, raised(scene.toolPose(0), 5e-4));
    scene.step();
  }
  EXPECT_LT(centreOf(snapshotOf(scene).tissues[0]).z(), before - 1e-3);
}

TEST_F(Jaws, SameBitsForAnyNumberOfThreads)
{
  std::uint64_t hash[2] = {};
  for (int threads = 1; threads <= 2; ++threads)
  {
    setThreadCount(threads);
    Scene scene(block(0.5));
    squeeze(scene, 0.0, kSqueeze, 20);
    hash[threads - 1] = scene.stateHash();
  }
  setThreadCount(1);
  EXPECT_EQ(hash[0], hash[1]);
}

TEST_F(Jaws, KeyFramesMoveJointsAndResetPutsThemBack)
{
  SceneConfig config = block(0.0);
  config.tools[0].initial_joints = {{"right", 0.002}};
  config.tools[0].joint_source.kind = JointSourceConfig::Kind::keyframes;
  config.tools[0].joint_source.keyframes = {{0.01, {{"left", 0.0}}}, {0.05, {{"left", 0.004}}}};
  Scene scene(config);
  for (int n = 1; n <= 6; ++n)
  {
    scene.setJointTargets(0, closedBy(0.001));  // means nothing to key-framed joints
    scene.step();
    const JointValues& q = snapshotOf(scene).tools[0].joints;
    EXPECT_NEAR(q[0], std::min(0.004, 0.001 * (n - 1)), 1e-15) << n;
    EXPECT_EQ(q[1], 0.002);
  }
  config.tools[0].joint_source = JointSourceConfig();
  Scene commanded(config);
  const std::uint64_t start = commanded.stateHash();
  commanded.setJointTargets(0, closedBy(0.001));
  EXPECT_EQ(commanded.stateHash(), start);
  commanded.step();
  EXPECT_EQ(snapshotOf(commanded).tools[0].joints, closedBy(0.001));
  commanded.resetWorld();
  EXPECT_EQ(snapshotOf(commanded).tools[0].joints[1], 0.002);
  EXPECT_EQ(snapshotOf(commanded).tools[0].joints[0], 0.0);
}

TEST_F(Jaws, TheRootMayStandStillAndTheFrameMove)
{
  SceneConfig config = block(0.0);
  config.tools[0].frame = 1;
  config.tools[0].pose_source.kind = PoseSourceConfig::Kind::base;
  config.tools[0].pose_source.base_pose.position_m = Vec3(0.0, 0.0, 0.2);
  Scene scene(config);
  const double x = 0.5 * (kJawOpening + kJawThickness);
  EXPECT_LT((scene.toolPose(0).translation() - Vec3(-x, 0.0, 0.2)).norm(), 1e-15);
  scene.setJointTargets(0, closedBy(0.003));
  scene.step();
  EXPECT_LT((scene.toolPose(0).translation() - Vec3(0.003 - x, 0.0, 0.2)).norm(), 1e-15);
  const ToolState tool = snapshotOf(scene).tools[0];
  EXPECT_LT((tool.parts[1].X_WP.translation() - Vec3(x - 0.003, 0.0, 0.2)).norm(), 1e-15);
}

std::string complaint(const SceneConfig& config)
{
  try
  {
    Scene scene(config);
    return "";
  }
  catch (const Error& error)
  {
    return error.what();
  }
}

TEST_F(Jaws, JointsThatCantBeAreNamed)
{
  const SceneConfig good = block(0.0);
  SceneConfig config = good;
  config.tools[0].initial_joints = {{"nose", 0.0}};
  EXPECT_EQ(complaint(config),
            "small scene: tools[0].initial_joints_rad_or_m: there is no joint 'nose' that moves by "
            "itself; there are left right");
  config.tools[0].initial_joints = {{"left", 0.03}};
  EXPECT_EQ(complaint(config),
            "small scene: tools[0].initial_joints_rad_or_m.left = 0.03, must be in [0, 0.02]");
  config = good;
  config.tools[0].joint_source.keyframes = {{0.0, {{"left", 0.0}}}, {1.0, {{"right", 0.0}}}};
  EXPECT_EQ(complaint(config),
            "small scene: tools[0].joint_source.keyframes must all give the same joints");
}

}  // namespace
}  // namespace soft_tissue::test
