#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/JointState.h>

#include <cmath>
#include <fstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/bag_poses.h"
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
  ASSERT_EQ(poses.joints.size(), 1u);
  EXPECT_EQ(poses.joints[0].times_s, (std::vector<double>{0.0, 2.0}));
  EXPECT_EQ(poses.joints[0].samples[1][0], 0.001);
  EXPECT_EQ(poses.joints[0].samples[1][1], 0.002);
  EXPECT_TRUE(std::isnan(poses.joints[0].samples[0][1]));
  EXPECT_TRUE(poses.jaws[0].empty());
  ASSERT_EQ(poses.warnings.size(), 2u);
  EXPECT_EQ(poses.warnings[0],
            "/psm/forceps/joint_states: 1 messages left out: no finite positions of the tool's "
            "joints");
}

TEST_F(BagJoints, aJawIsReadFromItsCommandsOrFromWhereItWas)
{
  tool_.jaw.emplace();
  tool_.jaw->joints = {{"left", 0.5}, {"right", 0.5}};
  write("/forceps/jaw/measured_js", 1.0, state(0.0, {"jaw"}, {0.01}));
  write("/forceps/jaw/measured_js", 2.0, state(0.0, {"jaw"}, {0.02}));
  const BagPoses poses = read();
  EXPECT_EQ(poses.jaws[0].times_s, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(poses.jaws[0].samples[1][1], 0.01);
  EXPECT_TRUE(poses.joints[0].empty());
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
  std::ofstream(scene) << "tissues:\n"
                          "  - name: block\n"
                          "    mesh: {file: " SOURCE_DIR
                          "/test/ros/block.msh, length_unit: m}\n"
                          "    material: {young_modulus_pa: 5000, poisson_ratio: 0.4, "
                          "density_kg_per_m3: 1000}\n"
                          "tools:\n"
                          "  - name: psm\n"
                          "    shape: {urdf: {file: " SOURCE_DIR
                          "/config/tools/grasper.urdf, links: [jaw_1, jaw_2], frame: shaft}}\n"
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
