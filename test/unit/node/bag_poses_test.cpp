#include "soft_tissue_sim/node/bag_poses.h"

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/Header.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/scratch_folder.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::PoseSourceConfig;
using soft_tissue::ToolConfig;
using soft_tissue::Vec3;

geometry_msgs::PoseStamped pose(double stamp, double x, const std::string& frame = "world")
{
  geometry_msgs::PoseStamped message;
  message.header.stamp = ros::Time(stamp);
  message.header.frame_id = frame;
  message.pose.position.x = x;
  message.pose.orientation.w = 1.0;
  return message;
}

ToolConfig topicTool(const std::string& name)
{
  ToolConfig tool;
  tool.name = name;
  return tool;
}

bool contains(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

class BagPosesTest : public testing::Test
{
 protected:
  BagPosesTest() { bag_.open(path(), rosbag::bagmode::Write); }

  std::string path() const { return folder_.path() + "/poses.bag"; }

  template <typename Message>
  void write(const std::string& topic, double recorded, const Message& message)
  {
    bag_.write(topic, ros::Time(recorded), message);
  }

  BagPoses read(const std::vector<ToolConfig>& tools = {topicTool("probe")})
  {
    bag_.close();
    return readBagPoses(path(), tools, "world");
  }

  std::string complaint(const std::vector<ToolConfig>& tools = {topicTool("probe")})
  {
    try
    {
      read(tools);
      return "";
    }
    catch (const soft_tissue::Error& error)
    {
      return error.what();
    }
  }

  ScratchFolder folder_;
  rosbag::Bag bag_;
};

TEST_F(BagPosesTest, samplesComeInTheOrderOfTheirStamps)
{
  write("/psm/probe/servo_cp", 20.0, pose(12.0, 0.2));
  write("/psm/probe/servo_cp", 21.0, pose(10.0, 0.0));
  write("/psm/probe/servo_cp", 22.0, pose(11.0, 0.1));
  const BagPoses poses = read();
  EXPECT_EQ(poses.start, ros::Time(10.0));
  EXPECT_DOUBLE_EQ(poses.length_s, 2.0);
  ASSERT_EQ(poses.tools.size(), 1u);
  EXPECT_EQ(poses.tools[0].times_s, (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_EQ(poses.tools[0].samples[1].translation().x(), 0.1);
}

TEST_F(BagPosesTest, recordingTimeStandsInForAZeroStamp)
{
  write("/probe/servo_cp", 5.0, pose(0.0, 0.1));
  write("/probe/servo_cp", 6.5, pose(0.0, 0.2));
  EXPECT_EQ(read().tools[0].times_s, (std::vector<double>{0.0, 1.5}));
}

TEST_F(BagPosesTest, commandsGoBeforeMeasurements)
{
  write("/a/probe/measured_cp", 1.0, pose(1.0, 0.5));
  write("/a/probe/servo_cp", 2.0, pose(2.0, 0.1));
  const BagPoses poses = read();
  ASSERT_EQ(poses.tools[0].times_s.size(), 1u);
  EXPECT_EQ(poses.tools[0].samples[0].translation().x(), 0.1);
}

TEST_F(BagPosesTest, measurementsServeWhereThereAreNoCommands)
{
  write("/a/probe/measured_cp", 1.0, pose(1.0, 0.5));
  write("/a/otherprobe/servo_cp", 1.0, pose(1.0, 0.7));
  EXPECT_EQ(read().tools[0].samples[0].translation().x(), 0.5);
}

TEST_F(BagPosesTest, posesTheNodeWouldRejectAreLeftOutAndReported)
{
  write("/probe/servo_cp", 1.0, pose(1.0, 0.1));
  write("/probe/servo_cp", 2.0, pose(2.0, std::numeric_limits<double>::quiet_NaN()));
  write("/probe/servo_cp", 3.0, pose(3.0, 11.0));
  write("/probe/servo_cp", 4.0, pose(4.0, 0.4, "nowhere"));
  const BagPoses poses = read();
  EXPECT_EQ(poses.tools[0].times_s.size(), 1u);
  ASSERT_EQ(poses.warnings.size(), 3u);
  for (const std::string& warning : poses.warnings)
  {
    EXPECT_TRUE(contains(warning, "/probe/servo_cp: 1 poses left out")) << warning;
  }
}

TEST_F(BagPosesTest, framesAreResolvedThroughTfInTheBag)
{
  tf2_msgs::TFMessage transforms;
  transforms.transforms.resize(1);
  transforms.transforms[0].header.frame_id = "world";
  transforms.transforms[0].child_frame_id = "base";
  transforms.transforms[0].transform.translation.y = 0.25;
  transforms.transforms[0].transform.rotation.w = 1.0;
  write("/tf_static", 9.0, transforms);
  write("/probe/servo_cp", 3.0, pose(3.0, 0.5, "base"));
  EXPECT_TRUE(read().tools[0].samples[0].translation().isApprox(Vec3(0.5, 0.25, 0.0), 1e-15));
}

TEST_F(BagPosesTest, aFollowedFrameIsSampledFromTf)
{
  for (const double time : {1.0, 2.0})
  {
    tf2_msgs::TFMessage transforms;
    transforms.transforms.resize(1);
    transforms.transforms[0].header.stamp = ros::Time(time);
    transforms.transforms[0].header.frame_id = "world";
    transforms.transforms[0].child_frame_id = "leader";
    transforms.transforms[0].transform.translation.x = time;
    transforms.transforms[0].transform.rotation.w = 1.0;
    write("/tf", time, transforms);
  }
  ToolConfig tool = topicTool("probe");
  tool.pose_source.kind = PoseSourceConfig::Kind::tf;
  tool.pose_source.name = "leader";
  const BagPoses poses = read({tool});
  EXPECT_EQ(poses.tools[0].times_s, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(poses.tools[0].samples[1].translation().x(), 2.0);
}

TEST_F(BagPosesTest, withoutPosesTheTopicsOfTheBagAreNamed)
{
  write("/chatter", 1.0, std_msgs::Header());
  const std::string text = complaint();
  EXPECT_TRUE(contains(text, "/chatter (std_msgs/Header)")) << text;
  EXPECT_TRUE(contains(text, "probe/servo_cp or probe/measured_cp")) << text;
}

TEST_F(BagPosesTest, twoTopicsForOneToolAreRefused)
{
  write("/a/probe/servo_cp", 1.0, pose(1.0, 0.1));
  write("/b/probe/servo_cp", 1.0, pose(1.0, 0.1));
  const std::string text = complaint();
  EXPECT_TRUE(contains(text, "/a/probe/servo_cp and /b/probe/servo_cp")) << text;
}

TEST_F(BagPosesTest, aTopicOfAnotherTypeIsRefused)
{
  write("/probe/servo_cp", 1.0, std_msgs::Header());
  EXPECT_TRUE(contains(complaint(), "must be geometry_msgs/PoseStamped"));
}

TEST_F(BagPosesTest, aTruncatedBagIsRefused)
{
  for (int i = 0; i < 1000; ++i)
  {
    write("/probe/servo_cp", 1.0 + i, pose(1.0 + i, 0.1));
  }
  bag_.close();
  std::filesystem::resize_file(path(), std::filesystem::file_size(path()) / 2);
  EXPECT_TRUE(contains(complaint(), "poses.bag"));
}

TEST(BagPoses, filesThatAreNoBagsAreRefused)
{
  const ScratchFolder folder;
  EXPECT_THROW(readBagPoses(folder.path() + "/missing.bag", {topicTool("probe")}, "world"),
               soft_tissue::Error);
  const char* data = std::getenv("SOFT_TISSUE_DATA");
  if (data == nullptr)
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  for (const char* name : {"asci-file.txt", "empty-file.bag", "no-messages.bag", "example.bag",
                           "example-unsorted-chunks.bag", "example-lz4.bag", "example-bz2.bag"})
  {
    const std::string path = std::string(data) + "/bags/" + name;
    try
    {
      readBagPoses(path, {topicTool("probe")}, "world");
      ADD_FAILURE() << path << " has no poses of a probe";
    }
    catch (const soft_tissue::Error& error)
    {
      EXPECT_TRUE(contains(error.what(), name)) << error.what();
    }
  }
}

TEST(BagPoses, aFrameOfARealRecordingIsFollowed)
{
  const char* data = std::getenv("SOFT_TISSUE_DATA");
  if (data == nullptr)
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  ToolConfig turtle = topicTool("probe");
  turtle.pose_source.kind = PoseSourceConfig::Kind::tf;
  turtle.pose_source.name = "turtle1";
  const BagPoses poses = readBagPoses(std::string(data) + "/bags/example.bag", {turtle}, "world");
  EXPECT_GT(poses.tools[0].times_s.size(), 100u);
  EXPECT_TRUE(std::is_sorted(poses.tools[0].times_s.begin(), poses.tools[0].times_s.end()));
}

}  // namespace
}  // namespace soft_tissue_sim
