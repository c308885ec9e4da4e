#include "soft_tissue_sim/node/command_check.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>

namespace soft_tissue_sim
{
namespace
{
geometry_msgs::Pose goodPose()
{
  geometry_msgs::Pose pose;
  pose.position.z = 0.1;
  pose.orientation.w = 1.0;
  return pose;
}

TEST(CheckPose, acceptsUsualPoses)
{
  EXPECT_EQ(checkPose(goodPose()), Rejection::none);
  geometry_msgs::Pose pose = goodPose();
  pose.orientation.w = 1.0009;
  pose.position.x = 9.9;
  EXPECT_EQ(checkPose(pose), Rejection::none);
}

TEST(CheckPose, refusesWhatIsNotFinite)
{
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300})
  {
    geometry_msgs::Pose pose = goodPose();
    pose.position.y = bad;
    EXPECT_EQ(checkPose(pose), Rejection::not_finite) << bad;
    pose = goodPose();
    pose.orientation.x = bad;
    EXPECT_EQ(checkPose(pose), Rejection::not_finite) << bad;
  }
}

TEST(CheckPose, refusesQuaternionsThatAreNotUnit)
{
  for (const double w : {0.0, 0.9985, 1.0015, 2.0})
  {
    geometry_msgs::Pose pose = goodPose();
    pose.orientation.w = w;
    EXPECT_EQ(checkPose(pose), Rejection::not_unit) << w;
  }
}

TEST(CheckPose, refusesPositionsBeyondTenMetres)
{
  geometry_msgs::Pose pose = goodPose();
  pose.position.x = 8.0;
  pose.position.y = -8.0;
  EXPECT_EQ(checkPose(pose), Rejection::too_far);
}

TEST(StampOrder, neverGoesBackUnlessRestarted)
{
  StampOrder order;
  EXPECT_TRUE(order.accepts(ros::Time(5.0)));
  order.accept(ros::Time(5.0), ros::Time(5.1));
  EXPECT_TRUE(order.accepts(ros::Time(5.0)));
  EXPECT_TRUE(order.accepts(ros::Time(6.0)));
  EXPECT_FALSE(order.accepts(ros::Time(4.999)));
  order.restart();
  EXPECT_TRUE(order.accepts(ros::Time(4.999)));
}

TEST(StampOrder, zeroMeansNow)
{
  StampOrder order;
  order.accept(ros::Time(5.0), ros::Time(5.1));
  EXPECT_TRUE(order.accepts(ros::Time()));
  order.accept(ros::Time(), ros::Time(5.2));
  EXPECT_FALSE(order.accepts(ros::Time(4.0)));
}

TEST(StampOrder, aStampAheadOfTheClockBarsNothingThatComesInTime)
{
  StampOrder order;
  order.accept(ros::Time(500.0), ros::Time(5.0));
  EXPECT_TRUE(order.accepts(ros::Time(5.0)));
  EXPECT_FALSE(order.accepts(ros::Time(4.999)));
}

TEST(RejectionText, isDifferentForEach)
{
  std::set<std::string> texts;
  for (int i = 0; i < kRejectionCount; ++i)
  {
    texts.insert(rejectionText(static_cast<Rejection>(i)));
  }
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(kRejectionCount));
}

}  // namespace
}  // namespace soft_tissue_sim
