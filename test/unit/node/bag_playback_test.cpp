#include "soft_tissue_sim/node/bag_playback.h"

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <octomap_msgs/Octomap.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <set>

#include "soft_tissue_sim/node/scratch_folder.h"
#include "support/forceps.h"

namespace soft_tissue_sim
{
namespace
{
using Kind = soft_tissue::PoseSourceConfig::Kind;

class BagPlayback : public testing::Test
{
 protected:
  BagPlayback()
  {
    add("probe", Kind::topic, "servo_cp");
    add("flyer", Kind::twist, "servo_cv");
    add("dragged", Kind::marker, "");
    add("psm", Kind::topic, "setpoint_cp");
    config_.tools.back().linkage = soft_tissue::test::forcepsLinkage();
    config_.tools.back().jaw.emplace();
    config_.tools.back().jaw->joints = {{"left", 1.0}};
    config_.obstacles.resize(1);
    config_.obstacles[0].octomap.topic = "octomap_in";
    bag_.open(path(), rosbag::bagmode::Write);
  }

  void add(const std::string& name, Kind kind, const std::string& source)
  {
    config_.tools.emplace_back();
    config_.tools.back().name = name;
    config_.tools.back().pose_source.kind = kind;
    config_.tools.back().pose_source.name = source;
  }

  std::string path() const { return folder_.path() + "/played.bag"; }

  template <typename Message>
  void record(const std::string& topic)
  {
    bag_.write(topic, ros::Time(1.0), Message());
  }

  std::set<std::string> played()
  {
    bag_.close();
    std::set<std::string> lines;
    for (const PlayedTopic& topic : playedTopics(path(), config_, warnings_))
    {
      lines.insert(topic.recorded + ":=" + topic.name);
    }
    return lines;
  }

  ScratchFolder folder_;
  soft_tissue::SceneConfig config_;
  rosbag::Bag bag_;
  std::vector<std::string> warnings_;
};

TEST_F(BagPlayback, bringsEachStreamToWhereTheNodeTakesIt)
{
  record<geometry_msgs::PoseStamped>("/a/probe/servo_cp");
  record<geometry_msgs::PoseStamped>("/a/probe/measured_cp");
  record<geometry_msgs::TwistStamped>("/b/flyer/servo_cv");
  record<geometry_msgs::PoseStamped>("/b/flyer/measured_cp");
  record<geometry_msgs::PoseStamped>("/c/psm/measured_cp");
  record<sensor_msgs::JointState>("/c/psm/joint_states");
  record<sensor_msgs::JointState>("/c/psm/jaw/measured_js");
  record<octomap_msgs::Octomap>("/map/octomap_in");
  record<tf2_msgs::TFMessage>("/tf");
  record<tf2_msgs::TFMessage>("/other");
  const std::set<std::string> expected{"/a/probe/servo_cp:=probe/servo_cp",
                                       "/b/flyer/servo_cv:=flyer/servo_cv",
                                       "/c/psm/measured_cp:=psm/setpoint_cp",
                                       "/c/psm/joint_states:=psm/joint_states",
                                       "/c/psm/jaw/measured_js:=psm/jaw/servo_jp",
                                       "/map/octomap_in:=octomap_in",
                                       "/tf:=/tf"};
  EXPECT_EQ(played(), expected);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(BagPlayback, saysWhatItCanNotBring)
{
  record<geometry_msgs::PoseStamped>("/a/dragged/measured_cp");
  record<geometry_msgs::PoseStamped>("/a/flyer/measured_cp");
  EXPECT_TRUE(played().empty());
  const std::vector<std::string> expected{
      "it has nothing for probe/servo_cp",
      "/a/flyer/measured_cp: the pose_source of tool 'flyer' takes no poses from topics",
      "/a/dragged/measured_cp: the pose_source of tool 'dragged' takes no poses from topics",
      "it has nothing for psm/setpoint_cp"};
  EXPECT_EQ(warnings_, expected);
}

}  // namespace
}  // namespace soft_tissue_sim
