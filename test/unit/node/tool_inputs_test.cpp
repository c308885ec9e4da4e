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

  std::vector<double> heights_, stamps_;  ///< of accepted commands
  CommandGate gate_{"probe",
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

TEST(CommandGate, silenceIsWatchedAlsoOverAJumpOfTheClock)
{
  ros::Time::init();
  ros::Time::setNow(ros::Time(1000.0));
  CommandGate gate(
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
