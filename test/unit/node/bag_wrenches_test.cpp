#include "soft_tissue_sim/node/bag_wrenches.h"

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/Header.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <limits>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/scratch_folder.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Error;
using soft_tissue::Vec3;
using soft_tissue::Wrench;

geometry_msgs::WrenchStamped force(double stamp, double x, const std::string& frame = "world")
{
  geometry_msgs::WrenchStamped message;
  message.header.stamp = ros::Time(stamp);
  message.header.frame_id = frame;
  message.wrench.force.x = x;
  message.wrench.torque.z = 0.1 * x;
  return message;
}

class BagWrenches : public testing::Test
{
 protected:
  BagWrenches() { bag_.open(path(), rosbag::bagmode::Write); }

  std::string path() const { return folder_.path() + "/forces.bag"; }

  template <typename Message>
  void write(const std::string& topic, const Message& message)
  {
    bag_.write(topic, ros::Time(50.0), message);
  }

  WrenchSeries read()
  {
    bag_.close();
    soft_tissue::ToolConfig tool;
    tool.name = "probe";
    return readBagWrenches(path(), {tool}, "world", ros::Time(10.0), warnings_)[0];
  }

  ScratchFolder folder_;
  rosbag::Bag bag_;
  std::vector<std::string> warnings_;
};

TEST_F(BagWrenches, areSortedByStampFromTheStartOn)
{
  write("/psm/probe/body/measured_cf", force(10.02, 3.0));
  write("/psm/probe/body/measured_cf", force(9.99, 1.0));
  write("/psm/probe/body/measured_cf", force(10.0, 2.0, "anything"));
  const WrenchSeries series = read();
  EXPECT_TRUE(series.in_tool_axes);
  ASSERT_EQ(series.times_s.size(), 2u);
  EXPECT_EQ(series.wrenches[0].force, Vec3(2.0, 0.0, 0.0));
  EXPECT_NEAR(series.times_s[1], 0.02, 1e-9);
  EXPECT_NEAR(series.at(0.01)->force.x(), 2.5, 1e-6);
  EXPECT_NEAR(series.at(0.01)->torque.z(), 0.25, 1e-6);
  EXPECT_FALSE(series.at(-0.01));
  EXPECT_FALSE(series.at(0.03));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(BagWrenches, areUnknownInGaps)
{
  write("/probe/body/measured_cf", force(10.0, 1.0));
  write("/probe/body/measured_cf", force(10.5, 2.0));
  const WrenchSeries series = read();
  EXPECT_FALSE(series.at(0.25));
  EXPECT_TRUE(series.at(0.5));
}

TEST_F(BagWrenches, areTurnedToTheWorldWhereTheyAreInAnotherFrame)
{
  geometry_msgs::TransformStamped turned;  // x of the table is y of the world
  turned.header.frame_id = "world";
  turned.child_frame_id = "table";
  turned.transform.rotation.z = turned.transform.rotation.w = std::sqrt(0.5);
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(turned);
  write("/tf_static", tf);
  write("/probe/spatial/measured_cf", force(10.0, 2.0, "table"));
  write("/probe/spatial/measured_cf", force(10.1, 2.0, "nowhere"));
  write("/probe/spatial/measured_cf", force(10.2, std::numeric_limits<double>::quiet_NaN()));
  const WrenchSeries series = read();
  EXPECT_FALSE(series.in_tool_axes);
  ASSERT_EQ(series.wrenches.size(), 1u);
  EXPECT_NEAR((series.wrenches[0].force - Vec3(0.0, 2.0, 0.0)).norm(), 0.0, 1e-12);
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_NE((warnings_[0] + warnings_[1]).find("nowhere"), std::string::npos);
  EXPECT_NE((warnings_[0] + warnings_[1]).find("not finite"), std::string::npos);
}

TEST_F(BagWrenches, startAtZeroAfterATare)
{
  for (int i = 0; i <= 10; ++i)
  {
    write("/probe/body/measured_cf", force(10.0 + 0.1 * i, i < 5 ? 1.0 + 0.1 * (i % 2) : 4.0));
  }
  WrenchSeries series = read();
  series.tare(0.35);
  EXPECT_NEAR(series.wrenches[0].force.x(), -0.05, 1e-12);
  EXPECT_NEAR(series.wrenches[10].force.x(), 2.95, 1e-12);
  EXPECT_NEAR(series.wrenches[10].torque.z(), 0.295, 1e-12);
  WrenchSeries none;
  EXPECT_THROW(none.tare(1.0), Error);
}

TEST_F(BagWrenches, areRefusedFromTwoTopicsOrOfAnotherType)
{
  write("/a/probe/body/measured_cf", force(10.0, 1.0));
  write("/b/probe/body/measured_cf", force(10.0, 1.0));
  EXPECT_THROW(read(), Error);
  bag_.open(path(), rosbag::bagmode::Write);
  write("/a/probe/body/measured_cf", std_msgs::Header());
  EXPECT_THROW(read(), Error);
}

TEST_F(BagWrenches, mayBeMissing)
{
  write("/chatter", std_msgs::Header());
  EXPECT_TRUE(read().empty());
}

}  // namespace
}  // namespace soft_tissue_sim
