#include "soft_tissue_sim/node/tool_inputs.h"

#include <gtest/gtest.h>

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

  CommandSlot slot_;
  CommandGate gate_{"probe", slot_, 0.5};
  tf2_ros::Buffer buffer_;
};

TEST_F(Followed, newPosesAreCommandsAndOldOnesAreNot)
{
  TfInput input("leader", gate_, buffer_, "world", 0.0);
  soft_tissue::Pose X_WT;
  buffer_.setTransform(leaderAt(0.07, 1.0), "test");
  input.poll();
  ASSERT_TRUE(slot_.take(X_WT));
  EXPECT_EQ(X_WT.translation(), soft_tissue::Vec3(0.0, 0.0, 0.07));
  input.poll();
  EXPECT_FALSE(slot_.take(X_WT));
  buffer_.setTransform(leaderAt(0.08, 1.1), "test");
  input.poll();
  EXPECT_TRUE(slot_.take(X_WT));
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

TEST(CommandGate, silenceIsWatchedAlsoOverAJumpOfTheClock)
{
  ros::Time::init();
  ros::Time::setNow(ros::Time(1000.0));
  CommandSlot slot;
  CommandGate gate("probe", slot, 0.5);
  EXPECT_FALSE(gate.stale());
  gate.accept(soft_tissue::Pose::Identity());
  ros::Time::setNow(ros::Time(1000.4));
  EXPECT_FALSE(gate.stale());
  ros::Time::setNow(ros::Time(1000.6));
  EXPECT_TRUE(gate.stale());
  gate.accept(soft_tissue::Pose::Identity());
  EXPECT_FALSE(gate.stale());
  ros::Time::setNow(ros::Time(500.0));
  EXPECT_TRUE(gate.stale());
  ros::Time::useSystemTime();
}

}  // namespace
}  // namespace soft_tissue_sim
