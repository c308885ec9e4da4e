#include "soft_tissue_sim/node/tool_inputs.h"

#include <gtest/gtest.h>
#include <tf2_ros/buffer.h>

#include <boost/make_shared.hpp>
#include <cmath>

namespace soft_tissue_sim
{
namespace
{
geometry_msgs::TransformStamped leaderAt(double z, double stamp_s)
{
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "world";
  transform.header.stamp = ros::Time(stamp_s);
  transform.child_frame_id = "leader";
  transform.transform.translation.z = z;
  transform.transform.rotation.w = 1.0;
  return transform;
}

class Followed : public testing::Test
{
 protected:
  Followed() { ros::Time::init(); }
  ~Followed() override { ros::Time::useSystemTime(); }

  std::uint64_t missing() const { return gate_.rejected(Rejection::unknown_frame); }

  std::vector<double> heights_, stamps_;  ///< of accepted commands
  PoseGate gate_{"probe",
                 [this](const soft_tissue::Pose& X_WT, std::optional<double> sent_s) {
                   heights_.push_back(X_WT.translation().z());
                   stamps_.push_back(sent_s.value_or(-1.0));
                 },
                 0.5};
  tf2_ros::Buffer buffer_;
};

TEST_F(Followed, newPosesAreCommandsAndOldOnesAreNot)
{
  TfInput input("leader", gate_, buffer_, "world", 0.0);
  buffer_.setTransform(leaderAt(0.07, 1.0), "test");
  input.poll();
  input.poll();
  EXPECT_EQ(heights_, std::vector<double>({0.07}));
  buffer_.setTransform(leaderAt(0.08, 1.1), "test");
  input.poll();
  EXPECT_EQ(heights_, std::vector<double>({0.07, 0.08}));
  EXPECT_EQ(stamps_, std::vector<double>({1.0, 1.1}));
  EXPECT_EQ(gate_.accepted(), 2u);
  EXPECT_EQ(gate_.rejectedInAll(), 0u);
}

TEST_F(Followed, aFrameTooFarAwayIsRejected)
{
  TfInput input("leader", gate_, buffer_, "world", 0.0);
  buffer_.setTransform(leaderAt(11.0, 1.0), "test");
  input.poll();
  EXPECT_EQ(gate_.rejected(Rejection::too_far), 1u);
}

TEST_F(Followed, aMissingFrameCountsOnceEachTimeItIsLost)
{
  TfInput input("leader", gate_, buffer_, "world", 0.0);
  input.poll();
  input.poll();
  EXPECT_EQ(missing(), 1u);
  buffer_.setTransform(leaderAt(0.07, 1.0), "test");
  input.poll();
  buffer_.clear();
  input.poll();
  input.poll();
  EXPECT_EQ(missing(), 2u);
}

TEST_F(Followed, aFrameMayBeLate)
{
  TfInput input("leader", gate_, buffer_, "world", 3600.0);
  input.poll();
  input.poll();
  EXPECT_EQ(missing(), 0u);
}

geometry_msgs::PoseStamped::Ptr poseCommand(const std::string& frame, double x)
{
  const auto command = boost::make_shared<geometry_msgs::PoseStamped>();
  command->header.frame_id = frame;
  command->pose.position.x = x;
  command->pose.orientation.w = 1.0;
  return command;
}

TEST_F(Followed, posesAreBroughtToTheWorld)
{
  PoseInput input(gate_, {buffer_, "world", 0.0});
  input.onCommand(poseCommand("leader", 1.0));
  EXPECT_EQ(missing(), 1u);
  buffer_.setTransform(leaderAt(0.07, 1.0), "test", true);
  input.onCommand(poseCommand("leader", 1.0));
  input.onCommand(poseCommand("", 1.0));
  input.onCommand(poseCommand("leader", std::nan("")));
  EXPECT_EQ(heights_, std::vector<double>({0.07, 0.0}));
  EXPECT_EQ(gate_.rejected(Rejection::not_finite), 1u);
}

TEST_F(Followed, aCommandWaitsForItsTransform)
{
  PoseInput input(gate_, {buffer_, "world", 3600.0});
  buffer_.setTransform(leaderAt(0.07, 1.0), "test");
  const auto command = poseCommand("leader", 0.0);
  command->header.stamp = ros::Time(1.5);
  input.onCommand(command);
  input.poll();
  EXPECT_TRUE(heights_.empty());
  buffer_.setTransform(leaderAt(0.09, 2.0), "test");
  input.poll();
  ASSERT_EQ(heights_.size(), 1u);
  EXPECT_NEAR(heights_[0], 0.08, 1e-12) << "half way between both transforms";
}

TEST(TwistInput, velocitiesAreTurnedIntoTheWorldsAxes)
{
  ros::Time::init();
  std::vector<Twist> taken;
  TwistGate gate(
      "probe", [&](const Twist& twist, std::optional<double>) { taken.push_back(twist); }, 0.5);
  tf2_ros::Buffer buffer;
  geometry_msgs::TransformStamped quarter = leaderAt(5.0, 1.0);  // about z
  quarter.transform.rotation.z = quarter.transform.rotation.w = std::sqrt(0.5);
  buffer.setTransform(quarter, "test", true);
  TwistInput input(gate, {buffer, "world", 0.0}, "probe");
  const auto send = [&](const std::string& frame, double x) {
    const auto command = boost::make_shared<geometry_msgs::TwistStamped>();
    command->header.frame_id = frame;
    command->twist.linear.x = x;
    command->twist.angular.y = 2.0;
    input.onCommand(command);
  };
  send("leader", 1.0);
  send("probe", 1.0);
  send("world", 1.0);
  send("nowhere", 1.0);
  send("world", std::nan(""));
  ASSERT_EQ(taken.size(), 3u);
  EXPECT_LT((taken[0].linear - soft_tissue::Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((taken[0].angular - soft_tissue::Vec3(-2, 0, 0)).norm(), 1e-15);
  EXPECT_FALSE(taken[0].in_own_axes);
  EXPECT_TRUE(taken[1].in_own_axes);
  EXPECT_EQ(taken[2].linear, soft_tissue::Vec3(1, 0, 0));
  EXPECT_FALSE(taken[2].in_own_axes);
  EXPECT_EQ(gate.rejected(Rejection::unknown_frame), 1u);
  EXPECT_EQ(gate.rejected(Rejection::not_finite), 1u);
}

TEST(CommandGate, silenceIsWatchedAlsoOverAJumpOfTheClock)
{
  ros::Time::init();
  ros::Time::setNow(ros::Time(1000.0));
  PoseGate gate(
      "probe", [](const soft_tissue::Pose&, std::optional<double>) {}, 0.5);
  EXPECT_FALSE(gate.stale());
  gate.accept(soft_tissue::Pose::Identity(), ros::Time());
  ros::Time::setNow(ros::Time(1000.4));
  EXPECT_FALSE(gate.stale());
  ros::Time::setNow(ros::Time(1000.6));
  EXPECT_TRUE(gate.stale());
  gate.accept(soft_tissue::Pose::Identity(), ros::Time());
  EXPECT_FALSE(gate.stale());
  ros::Time::setNow(ros::Time(500.0));
  EXPECT_TRUE(gate.stale());
  ros::Time::useSystemTime();
}

}  // namespace
}  // namespace soft_tissue_sim
