#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"
#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
PoseKeyframe keyframe(double time_s, const Vec3& position, const Vec3& rpy)
{
  PoseKeyframe frame;
  frame.time_s = time_s;
  frame.pose.position_m = position;
  frame.pose.rotation_rpy_rad = rpy;
  return frame;
}

/** A block held below whose top is lifted and turned about an upright axis through (0.01, 0, 0). */
class MovedNodes : public testing::TestWithParam<Stepper>
{
 protected:
  SceneConfig config()
  {
    SceneConfig config = blockScene(folder_, {4, 4, 3});
    fixBelow(config, 1e-6);
    config.solver.stepper = GetParam();
    NodeMotionConfig moved;
    moved.nodes = {Vec3(-1.0, -1.0, kBlockTop - 1e-6), Vec3(1.0, 1.0, 1.0)};
    moved.motion = {keyframe(0.1, {0.01, 0, 0}, Vec3::Zero()),
                    keyframe(0.3, {0.01, 0, 0.004}, {0, 0, 0.4})};
    config.tissues[0].keyframes = {moved};
    return config;
  }
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Steppers, MovedNodes,
                         testing::Values(Stepper::implicit_euler, Stepper::bdf2,
                                         Stepper::quasi_static));

TEST_P(MovedNodes, GoWithTheirFrameAndTakeOthersAlong)
{
  Scene scene(config());
  const Points rest = scene.tissues()[0].rest.nodes;
  Snapshot snapshot;
  for (int k = 1; k <= 50; ++k)
  {
    ASSERT_FALSE(scene.step().held);
    scene.fillSnapshot(snapshot);
    const double part = std::clamp((scene.time() - 0.1) / 0.2, 0.0, 1.0);
    Pose expected = Pose::Identity();
    expected.linear() = Eigen::AngleAxisd(0.4 * part, Vec3::UnitZ()).toRotationMatrix();
    expected.translation() = Vec3(0.01, 0, 0.004 * part) - expected.linear() * Vec3(0.01, 0, 0);
    double between = 0.0;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      const Vec3& x = snapshot.tissues[0].positions[i];
      if (rest[i].z() > kBlockTop - 1e-6)
      {
        ASSERT_LT((x - expected * rest[i]).norm(), 1e-14) << k;
      }
      else if (rest[i].z() < 1e-6)
      {
        ASSERT_EQ(x, rest[i]) << k;
      }
      else
      {
        between = std::max(between, (x - rest[i]).norm());
      }
    }
    EXPECT_EQ(between > 1e-6, part > 1e-9) << k;
  }
}

TEST_P(MovedNodes, AreHeldInOneWayOnly)
{
  const auto complaint = [](const SceneConfig& config) {
    try
    {
      Scene scene(config);
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
    return std::string("none");
  };
  SceneConfig twice = config();
  twice.tissues[0].keyframes.push_back(twice.tissues[0].keyframes[0]);
  EXPECT_EQ(complaint(twice),
            "small scene: tissues[0].keyframes[1].nodes.box_m holds nodes that are fixed, or moved "
            "by other key frames");
  SceneConfig fixed = config();
  fixBelow(fixed, 1.0);
  EXPECT_EQ(complaint(fixed),
            "small scene: tissues[0].keyframes[0].nodes.box_m holds nodes that are fixed, or moved "
            "by other key frames");
  SceneConfig none = config();
  none.tissues[0].keyframes[0].nodes.min.z() = 0.5;
  EXPECT_EQ(complaint(none),
            "small scene: tissues[0].keyframes[0].nodes.box_m holds no node of the mesh");
}
}  // namespace
}  // namespace soft_tissue::test
