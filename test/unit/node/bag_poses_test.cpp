#include "soft_tissue_sim/node/bag_poses.h"

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <std_msgs/Header.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/command_check.h"
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
  EXPECT_EQ(poses.tools[0].poses.times_s, (std::vector<double>{0.0, 1.0, 2.0}));
  EXPECT_EQ(poses.tools[0].poses.samples[1].translation().x(), 0.1);
}

TEST_F(BagPosesTest, recordingTimeStandsInForAZeroStamp)
{
  write("/probe/servo_cp", 5.0, pose(0.0, 0.1));
  write("/probe/servo_cp", 6.5, pose(0.0, 0.2));
  EXPECT_EQ(read().tools[0].poses.times_s, (std::vector<double>{0.0, 1.5}));
}

TEST_F(BagPosesTest, commandsGoBeforeMeasurements)
{
  write("/a/probe/measured_cp", 1.0, pose(1.0, 0.5));
  write("/a/probe/servo_cp", 2.0, pose(2.0, 0.1));
  const BagPoses poses = read();
  ASSERT_EQ(poses.tools[0].poses.times_s.size(), 1u);
  EXPECT_EQ(poses.tools[0].poses.samples[0].translation().x(), 0.1);
}

TEST_F(BagPosesTest, measurementsServeWhereThereAreNoCommands)
{
  write("/a/probe/measured_cp", 1.0, pose(1.0, 0.5));
  write("/a/otherprobe/servo_cp", 1.0, pose(1.0, 0.7));
  EXPECT_EQ(read().tools[0].poses.samples[0].translation().x(), 0.5);
}

TEST_F(BagPosesTest, eachMessageIsUsedOrRejectedForAReason)
{
  write("/probe/servo_cp", 1.0, pose(1.0, 0.1));
  write("/probe/servo_cp", 2.0, pose(2.0, std::numeric_limits<double>::quiet_NaN()));
  write("/probe/servo_cp", 3.0, pose(3.0, 11.0));
  write("/probe/servo_cp", 4.0, pose(4.0, 0.4, "nowhere"));
  write("/probe/servo_cp", 5.0, pose(5.0, 0.5));
  write("/probe/servo_cp", 5.1, pose(5.0, 0.6));
  write("/probe/servo_cp", 5.2, pose(4.5, 0.7));
  const BagPoses poses = read();
  EXPECT_EQ(poses.tools[0].poses.times_s, (std::vector<double>{0.0, 3.5, 4.0}));
  EXPECT_EQ(poses.tools[0].poses.samples[2].translation().x(), 0.6) << "the later of both";
  ASSERT_EQ(poses.tools[0].counts.size(), 1u);
  const StreamCounts& counts = poses.tools[0].counts[0];
  EXPECT_EQ(counts.of, "pose");
  EXPECT_EQ(counts.topic, "/probe/servo_cp");
  EXPECT_EQ(counts.messages, 7u);
  EXPECT_EQ(counts.used, 3u);
  EXPECT_EQ(counts.out_of_order, 1u);
  const std::map<std::string, std::size_t> reasons{{rejectionText(Rejection::not_finite), 1},
                                                   {rejectionText(Rejection::too_far), 1},
                                                   {rejectionText(Rejection::unknown_frame), 1},
                                                   {"another one after it has the same stamp", 1}};
  EXPECT_EQ(counts.rejected, reasons);
  ASSERT_EQ(poses.warnings.size(), 4u);
  for (const std::string& warning : poses.warnings)
  {
    EXPECT_TRUE(contains(warning, "/probe/servo_cp (pose): 1 of 7 left out")) << warning;
  }
  EXPECT_TRUE(contains(poses.warnings[3], "nowhere")) << poses.warnings[3];
}

geometry_msgs::TransformStamped link(const std::string& parent, const std::string& child, double x,
                                     double angle, double stamp)
{
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time(stamp);
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.translation.x = x;
  transform.transform.rotation.z = std::sin(0.5 * angle);
  transform.transform.rotation.w = std::cos(0.5 * angle);
  return transform;
}

tf2_msgs::TFMessage message(const std::vector<geometry_msgs::TransformStamped>& transforms)
{
  tf2_msgs::TFMessage message;
  message.transforms = transforms;
  return message;
}

constexpr double kQuarter = 0.5 * M_PI;

TEST_F(BagPosesTest, framesAreResolvedThroughTfInTheBag)
{
  write("/tf_static", 9.0, message({link("world", "base", 0.25, kQuarter, 0.0)}));
  write("/probe/servo_cp", 3.0, pose(3.0, 0.5, "base"));
  EXPECT_TRUE(read().tools[0].poses.samples[0].translation().isApprox(Vec3(0.25, 0.5, 0.0), 1e-15));
}

TEST_F(BagPosesTest, framesThatMoveAreWhereTfHasThemAtTheStamp)
{
  // world -(moves 1 m/s)-> cart -(fixed, a quarter turn)-> base -(turns 0.1 rad/s)-> arm
  write("/tf_static", 1.0, message({link("cart", "base", 0.1, kQuarter, 0.0)}));
  for (int i = 0; i <= 10; ++i)
  {
    const double time = 2.0 + 0.1 * i;
    write("/tf", time, message({link("world", "cart", 0.1 * i, 0.0, time)}));
    write("/tf", time + 0.05, message({link("base", "arm", 0.0, 0.01 * i, time)}));
  }
  write("/probe/servo_cp", 2.3, pose(2.3, 0.5, "arm"));
  write("/probe/servo_cp", 2.5, pose(2.55, 0.5, "arm"));   // between two transforms
  write("/probe/servo_cp", 3.1, pose(3.001, 0.5, "arm"));  // after the last
  write("/probe/servo_cp", 1.9, pose(1.9, 0.5, "arm"));    // before the first
  const BagPoses poses = read();
  ASSERT_EQ(poses.tools[0].poses.samples.size(), 2u);
  for (int i = 0; i < 2; ++i)
  {
    const double since = i == 0 ? 0.3 : 0.55, angle = kQuarter + 0.1 * since;
    const Vec3 expected(since + 0.1 + 0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.0);
    EXPECT_LT((poses.tools[0].poses.samples[i].translation() - expected).norm(), 1e-12) << i;
  }
  EXPECT_EQ(poses.tools[0].counts[0].rejected,
            (std::map<std::string, std::size_t>{{rejectionText(Rejection::no_transform), 2}}));
}

TEST_F(BagPosesTest, aFollowedFrameIsSampledWhenSomethingMovesIt)
{
  write("/tf_static", 1.0, message({link("world", "base", 0.0, 0.0, 0.0)}));
  for (const double time : {1.0, 2.0})
  {
    write("/tf", time, message({link("base", "leader", time, 0.0, time)}));
    write("/tf", time, message({link("world", "other", time, 0.0, time + 0.5)}));
  }
  ToolConfig tool = topicTool("probe");
  tool.pose_source.kind = PoseSourceConfig::Kind::tf;
  tool.pose_source.name = "leader";
  const BagPoses poses = read({tool});
  EXPECT_EQ(poses.tools[0].poses.times_s, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(poses.tools[0].poses.samples[1].translation().x(), 2.0);
  EXPECT_EQ(poses.tools[0].counts[0].messages, 2u) << "not those of others";
}

TEST_F(BagPosesTest, transformsThatTfCanNotTakeAreLeftOut)
{
  write("/tf_static", 1.0, message({link("world", "base", std::nan(""), 0.0, 0.0)}));
  write("/tf", 1.0, message({link("world", "base", 0.0, 0.0, 4.2e9)}));
  write("/probe/servo_cp", 3.0, pose(3.0, 0.5));
  const BagPoses poses = read();
  EXPECT_EQ(poses.tools[0].counts[0].used, 1u);
  ASSERT_EQ(poses.warnings.size(), 2u);
  EXPECT_EQ(poses.warnings[0], "tf: 1 transforms left out: its stamp is beyond the end of time");
  EXPECT_EQ(poses.warnings[1], "tf: 1 transforms left out: not finite");
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

}  // namespace
}  // namespace soft_tissue_sim
