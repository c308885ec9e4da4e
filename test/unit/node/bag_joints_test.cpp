#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <fstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/bag_poses.h"
#include "soft_tissue_sim/node/command_check.h"
#include "soft_tissue_sim/node/geometry_conversions.h"
#include "soft_tissue_sim/node/scene_run.h"
#include "soft_tissue_sim/node/scratch_folder.h"
#include "support/forceps.h"

namespace soft_tissue_sim
{
namespace
{
sensor_msgs::JointState state(double stamp, const std::vector<std::string>& names,
                              const std::vector<double>& positions)
{
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time(stamp);
  message.name = names;
  message.position = positions;
  return message;
}

class BagJoints : public testing::Test
{
 protected:
  BagJoints()
  {
    tool_.name = "forceps";
    tool_.linkage = soft_tissue::test::forcepsLinkage();
    bag_.open(path(), rosbag::bagmode::Write);
  }

  std::string path() const { return folder_.path() + "/joints.bag"; }

  void write(const std::string& topic, double recorded, const sensor_msgs::JointState& message)
  {
    bag_.write(topic, ros::Time(recorded), message);
  }

  BagPoses read()
  {
    bag_.close();
    return readBagPoses(path(), {tool_}, "world");
  }

  ScratchFolder folder_;
  soft_tissue::ToolConfig tool_;
  rosbag::Bag bag_;
};

TEST_F(BagJoints, comeInTheOrderOfTheirStampsAndStayUntilNamedAgain)
{
  write("/psm/forceps/joint_states", 20.0, state(12.0, {"right"}, {0.002}));
  write("/psm/forceps/joint_states", 21.0, state(10.0, {"left", "wrist"}, {0.001, 7.0}));
  write("/psm/forceps/joint_states", 22.0, state(13.0, {"left"}, {std::nan("")}));
  const BagPoses poses = read();
  EXPECT_EQ(poses.start, ros::Time(10.0));
  EXPECT_DOUBLE_EQ(poses.length_s, 2.0);
  ASSERT_EQ(poses.tools.size(), 1u);
  EXPECT_EQ(poses.tools[0].joints.times_s, (std::vector<double>{0.0, 2.0}));
  EXPECT_EQ(poses.tools[0].joints.samples[1][0], 0.001);
  EXPECT_EQ(poses.tools[0].joints.samples[1][1], 0.002);
  EXPECT_TRUE(std::isnan(poses.tools[0].joints.samples[0][1]));
  EXPECT_TRUE(poses.tools[0].jaw.empty());
  ASSERT_EQ(poses.warnings.size(), 2u);
  EXPECT_EQ(poses.warnings[0],
            "/psm/forceps/joint_states (joints): 1 of 3 left out: NaN or infinity in it");
  ASSERT_EQ(poses.tools[0].counts.size(), 1u);
  EXPECT_EQ(poses.tools[0].counts[0].messages, 3u);
  EXPECT_EQ(poses.tools[0].counts[0].used, 2u);
  EXPECT_EQ(poses.tools[0].counts[0].out_of_order, 1u);
}

TEST_F(BagJoints, aJawIsReadFromItsCommandsOrFromWhereItWas)
{
  tool_.jaw.emplace();
  tool_.jaw->joints = {{"left", 0.5}, {"right", 0.5}};
  write("/forceps/jaw/measured_js", 1.0, state(0.0, {"jaw"}, {0.01}));
  write("/forceps/jaw/measured_js", 2.0, state(0.0, {"jaw"}, {0.02}));
  const BagPoses poses = read();
  EXPECT_EQ(poses.tools[0].jaw.times_s, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(poses.tools[0].jaw.samples[1][1], 0.01);
  EXPECT_TRUE(poses.tools[0].joints.empty());
}

TEST_F(BagJoints, areToldByTheFramesOfTheLinks)
{
  tool_.joint_source.kind = soft_tissue::JointSourceConfig::Kind::tf;
  tool_.joint_source.name = "arm_";
  const auto publish = [&](double stamp, const soft_tissue::JointValues& values, double beside) {
    tf2_msgs::TFMessage message;
    for (std::size_t link = 1; link < tool_.linkage.links().size(); ++link)
    {
      soft_tissue::Pose X = tool_.linkage.pose(0, link, values);
      X.translation().y() += beside;
      message.transforms.emplace_back();
      message.transforms.back().header.frame_id = "arm_palm";
      message.transforms.back().header.stamp = ros::Time(stamp);
      message.transforms.back().child_frame_id = "arm_" + tool_.linkage.links()[link].name;
      message.transforms.back().transform = transformMessage(X);
    }
    bag_.write("/tf", ros::Time(stamp), message);
  };
  soft_tissue::JointValues values(2);
  for (int i = 0; i < 4; ++i)
  {
    values << 0.001 * i, 0.002 * i;
    publish(10.0 + 0.1 * i, values, i == 2 ? 0.01 : 0.0);
  }
  const BagPoses poses = read();
  EXPECT_EQ(poses.start, ros::Time(10.0));
  const soft_tissue::JointSeries& joints = poses.tools[0].joints;
  ASSERT_EQ(joints.times_s.size(), 3u);
  const double steps[] = {0.0, 1.0, 3.0};
  for (int k = 0; k < 3; ++k)
  {
    EXPECT_NEAR(joints.times_s[k], 0.1 * steps[k], 1e-9);
    EXPECT_NEAR(joints.samples[k][0], 0.001 * steps[k], 1e-12);
    EXPECT_NEAR(joints.samples[k][1], 0.002 * steps[k], 1e-12);
  }
  EXPECT_EQ(poses.tools[0].counts[0].topic, "/tf");
  EXPECT_EQ(poses.tools[0].counts[0].messages, 4u);
  EXPECT_EQ(poses.tools[0].counts[0].rejected,
            (std::map<std::string, std::size_t>{{rejectionText(Rejection::other_motion), 1}}));
}

TEST_F(BagJoints, anotherTypeIsRefused)
{
  bag_.write("/forceps/joint_states", ros::Time(1.0), geometry_msgs::PoseStamped());
  try
  {
    read();
    FAIL();
  }
  catch (const soft_tissue::Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("must be sensor_msgs/JointState"), std::string::npos)
        << error.what();
  }
}

TEST_F(BagJoints, areReplayedToTheEndAndRecordedAgain)
{
  const std::string scene = folder_.path() + "/scene.yaml";
  std::ofstream(scene)
      << "tissues:\n"
         "  - name: block\n"
         "    mesh: {file: " SOURCE_DIR
         "/test/ros/block.msh, length_unit: m}\n"
         "    material: {young_modulus_pa: 5000, poisson_ratio: 0.4, "
         "density_kg_per_m3: 1000}\n"
         "tools:\n"
         "  - name: psm\n"
         "    shape: {urdf: {file: " SOURCE_DIR
         "/config/tools/grasper.urdf, links: [shaft, jaw_1, jaw_2], frame: shaft}}\n"
         "    initial_pose: {position_m: [0, 0, 1]}\n"
         "    jaw: {joints: [{joint: jaw_1_joint, share: 0.5}]}\n";
  write("/psm/joint_states", 1.0, state(1.0, {"wrist"}, {0.1}));
  write("/psm/joint_states", 1.1, state(1.1, {"wrist"}, {0.2}));
  write("/psm/jaw/servo_jp", 1.0, state(1.0, {"jaw"}, {0.4}));
  write("/psm/jaw/servo_jp", 1.1, state(1.1, {"jaw"}, {0.5}));
  bag_.close();
  RunOptions options;
  options.scene = scene;
  options.quiet = true;
  options.bag_in = path();
  options.bag_out = folder_.path() + "/out.bag";
  runScene(options);
  rosbag::Bag out(options.bag_out);
  double first_jaw = 0.0, jaw = 0.0, wrist = 0.0;
  for (const rosbag::MessageInstance& one :
       rosbag::View(out, rosbag::TopicQuery("/sim_node/psm/jaw/measured_js")))
  {
    jaw = one.instantiate<sensor_msgs::JointState>()->position.at(0);
    first_jaw = first_jaw == 0.0 ? jaw : first_jaw;
  }
  for (const rosbag::MessageInstance& one :
       rosbag::View(out, rosbag::TopicQuery("/sim_node/psm/measured_js")))
  {
    const auto joints = one.instantiate<sensor_msgs::JointState>();
    ASSERT_EQ(joints->name.at(0), "wrist");
    wrist = joints->position.at(0);
  }
  EXPECT_NEAR(first_jaw, 0.405, 1e-9) << "5 ms after the start, which is there at once";
  EXPECT_NEAR(jaw, 0.5, 1e-9);
  EXPECT_NEAR(wrist, 0.2, 1e-9);
}

}  // namespace
}  // namespace soft_tissue_sim
