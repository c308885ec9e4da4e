#include "soft_tissue_sim/node/joint_inputs.h"

#include <gtest/gtest.h>
#include <tf2_ros/buffer.h>

#include <cmath>
#include <memory>

#include "soft_tissue_sim/node/geometry_conversions.h"
#include "support/forceps.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::JointKind;
using soft_tissue::JointValues;
using soft_tissue::Link;
using soft_tissue::Pose;
using soft_tissue::Vec3;

/** The forceps' two joints, of [0, 0.02] m, and a wrist without limits. */
class Joints : public testing::Test
{
 protected:
  Joints()
  {
    ros::Time::init();
    tool_.name = "tool";
    tool_.linkage = soft_tissue::test::forcepsLinkage();
    Link wrist;
    wrist.name = "wrist";
    wrist.coordinate = tool_.linkage.add(soft_tissue::Coordinate{"turn"});
    wrist.X_PJ.translation().z() = 0.1;
    wrist.kind = JointKind::turning;
    wrist.axis_J = Vec3::UnitY();
    tool_.linkage.add(wrist);
  }

  void addJaw()
  {
    tool_.jaw.emplace();
    tool_.jaw->joints = {{"left", 0.5}, {"right", 0.25}};
  }

  static sensor_msgs::JointState state(const std::vector<std::string>& names,
                                       const std::vector<double>& positions, double stamp_s = 0.0)
  {
    sensor_msgs::JointState message;
    message.header.stamp = ros::Time(stamp_s);
    message.name = names;
    message.position = positions;
    return message;
  }

  void expectLast(double left, double right, double turn) const
  {
    ASSERT_FALSE(sent_.empty());
    const double expected[] = {left, right, turn};
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_TRUE(std::isnan(expected[k]) ? std::isnan(sent_.back()[k])
                                          : std::abs(sent_.back()[k] - expected[k]) < 1e-12)
          << k << ": " << sent_.back()[k];
    }
  }

  soft_tissue::ToolConfig tool_;
  std::vector<JointValues> sent_;
  JointGate gate_{
      "tool joint",
      [this](const JointValues& values, std::optional<double>) { sent_.push_back(values); }, 0.5};
  const double nan_ = std::nan("");
};

TEST_F(Joints, areTakenByNameAndKeptUntilNamedAgain)
{
  JointInput input(tool_, gate_);
  input.onState(state({"other", "turn"}, {7.0, 0.3}));
  expectLast(nan_, nan_, 0.3);
  input.onState(state({"left"}, {0.01}));
  expectLast(0.01, nan_, 0.3);
  EXPECT_EQ(gate_.accepted(), 2u);
  EXPECT_EQ(gate_.limited(), 0u);
}

TEST_F(Joints, badMessagesAreCountedAndChangeNothing)
{
  JointInput input(tool_, gate_);
  input.onState(state({"turn"}, {0.3}, 5.0));
  input.onState(state({"turn"}, {nan_}, 6.0));
  input.onState(state({"turn"}, {0.4}, 4.0));
  input.onState(state({"turn"}, {}, 6.0));
  input.onState(state({"other"}, {1.0}, 6.0));
  EXPECT_EQ(sent_.size(), 1u);
  EXPECT_EQ(gate_.rejected(Rejection::not_finite), 1u);
  EXPECT_EQ(gate_.rejected(Rejection::stamp_went_back), 1u);
  EXPECT_EQ(gate_.rejected(Rejection::no_joint), 2u);
}

TEST_F(Joints, commandsBeyondLimitsAreReported)
{
  JointInput input(tool_, gate_);
  input.onState(state({"left", "turn"}, {0.03, 100.0}));
  EXPECT_EQ(gate_.limited(), 1u);
  EXPECT_EQ(gate_.accepted(), 1u) << "and obeyed as far as can be";
}

TEST_F(Joints, aJawTakesItsJointsAlong)
{
  addJaw();
  JawInput jaw(tool_, gate_);
  jaw.onState(state({"jaw"}, {0.02}));
  expectLast(0.01, 0.005, nan_);
  jaw.onState(state({}, {0.04}));
  expectLast(0.02, 0.01, nan_);
  EXPECT_NEAR(jawPosition(tool_, sent_.back()), 0.04, 1e-15);
  jaw.onState(state({"a", "b"}, {0.0, 0.0}));
  EXPECT_EQ(gate_.rejected(Rejection::no_joint), 1u);
  JointInput input(tool_, gate_);
  input.onState(state({"left", "turn"}, {0.001, 0.2}));
  expectLast(nan_, nan_, 0.2);
}

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child,
                                          const Pose& X, double stamp_s)
{
  geometry_msgs::TransformStamped message;
  message.header.frame_id = parent;
  message.header.stamp = ros::Time(stamp_s);
  message.child_frame_id = child;
  message.transform = transformMessage(X);
  return message;
}

TEST_F(Joints, areToldByTheFramesOfTheLinks)
{
  tf2_ros::Buffer buffer;
  JointTfInput input(tool_, "arm_", gate_, buffer, 0.0);
  input.poll();
  input.poll();
  EXPECT_EQ(gate_.rejected(Rejection::unknown_frame), 1u) << "counted once";
  JointValues q(3);
  q << 0.004, 0.011, 0.0;
  double stamp_s = 1.0;
  const auto publish = [&] {
    for (std::size_t link = 1; link < tool_.linkage.links().size(); ++link)
    {
      buffer.setTransform(transform("arm_palm", "arm_" + tool_.linkage.links()[link].name,
                                    tool_.linkage.pose(0, link, q), stamp_s),
                          "test");
    }
    stamp_s += 0.1;
    input.poll();
  };
  publish();
  expectLast(0.004, 0.011, 0.0);
  input.poll();
  EXPECT_EQ(sent_.size(), 1u) << "what is not new is no command";
  for (int n = 1; n <= 8; ++n)
  {
    q[2] = n;  // more than one turn
    publish();
    expectLast(0.004, 0.011, n);
  }
  const Pose beside(Eigen::Translation3d(0.0, 0.01, 0.0));
  buffer.setTransform(transform("arm_palm", "arm_left_jaw", beside, stamp_s), "test");
  input.poll();
  EXPECT_EQ(gate_.rejected(Rejection::other_motion), 1u);
}

TEST(JointValue, isReadBackFromAnyPose)
{
  Link link;
  link.X_PJ.translate(Vec3(1, 2, 3)).rotate(Eigen::AngleAxisd(0.7, Vec3(1, 1, 0).normalized()));
  link.axis_J = Vec3(0.6, 0.0, 0.8);
  for (const double value : {-3.1, -0.5, 0.0, 1.0, 3.1, 40.0})
  {
    link.kind = JointKind::turning;
    Pose X = link.X_PJ;
    X.rotate(Eigen::AngleAxisd(value, link.axis_J));
    EXPECT_NEAR(jointValue(link, X, value + 0.5).value_or(1e9), value, 1e-9);
    link.kind = JointKind::sliding;
    EXPECT_EQ(jointValue(link, X, 0.0).has_value(), value == 0.0) << value;
    X = link.X_PJ;
    X.translate(value * link.axis_J);
    EXPECT_NEAR(jointValue(link, X, 0.0).value_or(1e9), value, 1e-9);
  }
}

}  // namespace
}  // namespace soft_tissue_sim
