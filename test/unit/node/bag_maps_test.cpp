#include "soft_tissue_sim/node/bag_maps.h"

#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <fstream>

#include "soft_tissue_sim/node/scene_run.h"
#include "soft_tissue_sim/scene/octomap_data.h"
#include "support/pressed_block.h"

namespace soft_tissue_sim
{
namespace
{
using namespace test;
using soft_tissue::Cell;
using soft_tissue::VoxelSet;

constexpr double kCell = 0.005;  // m

/** A block that falls from z = 0, a ball far away whose poses make the bag, and maps in that. */
class BagMapsTest : public testing::Test
{
 protected:
  BagMapsTest()
  {
    std::ofstream(scene()) << "time_step_s: 0.01\n"
                              "tissues:\n"
                              "  - name: block\n"
                              "    mesh: {file: " SOURCE_DIR
                              "/test/ros/block.msh, length_unit: m}\n"
                              "    material: {young_modulus_pa: 20000, poisson_ratio: 0.4, "
                              "density_kg_per_m3: 1000}\n"
                              "tools:\n"
                              "  - name: probe\n"
                              "    shape: {sphere: {radius_m: 0.008}}\n"
                              "    pose_source: {topic: servo_cp}\n"
                              "obstacles:\n"
                              "  - name: floor\n"
                              "    octomap: {topic: octomap_in, resolution_m: 0.005}\n"
                              "contacts: [{between: [block, floor]}]\n";
    bag_.open(pressed_.path("maps.bag"), rosbag::bagmode::Write);
    for (int i = 0; i <= 50; ++i)
    {
      geometry_msgs::PoseStamped pose;
      pose.header.stamp = ros::Time(100.0 + 0.01 * i);
      pose.pose.position.z = 1.0;
      pose.pose.orientation.w = 1.0;
      bag_.write("/probe/servo_cp", pose.header.stamp, pose);
    }
  }

  std::string scene() const { return pressed_.path("scene.yaml"); }

  /** A floor with its top at this height, m. */
  static octomap_msgs::Octomap floorAt(double top, double stamp, const std::string& frame = "")
  {
    VoxelSet cells(kCell);
    const int above = static_cast<int>(std::lround(top / kCell));
    cells.fill({Cell(-12, -12, above - 4), Cell(12, 12, above)}, true);
    const soft_tissue::OctomapData data = soft_tissue::octomapOf(cells, VoxelSet(kCell), true);
    octomap_msgs::Octomap message;
    message.header.stamp = ros::Time(stamp);
    message.header.frame_id = frame;
    message.binary = true;
    message.id = data.id;
    message.resolution = data.resolution;
    message.data.assign(data.bytes.begin(), data.bytes.end());
    return message;
  }

  void write(const octomap_msgs::Octomap& message)
  {
    bag_.write("/sensor/octomap_in", ros::Time(100.2), message);
  }

  /** Where the block's lowest node ends, m, and the state's hash. */
  std::pair<double, std::string> run(const std::string& name)
  {
    bag_.close();
    RunOptions options = pressed_.options(name);
    options.scene = scene();
    options.bag_in = pressed_.path("maps.bag");
    options.state_rate_hz = 0.0;
    runScene(options);
    const std::string json = PressedBlock::contents(options.json);
    const auto valueOf = [&](const std::string& key) {
      return json.substr(json.find("\"" + key + "\": ") + key.size() + 4, 20);
    };
    return {-std::stod(valueOf("max_displacement_m")), valueOf("state_hash")};
  }

  PressedBlock pressed_;
  rosbag::Bag bag_;
};

TEST_F(BagMapsTest, HoldWhatWouldFall)
{
  const auto [fallen, unused] = run("free");
  EXPECT_LT(fallen, -1.0);
  bag_.open(pressed_.path("maps.bag"), rosbag::bagmode::Append);
  write(floorAt(-0.02, 90.0));  // latched before
  const auto [first, hash] = run("first");
  std::printf("  free %.3f m, on a floor %.4f m below %.4f m\n", fallen, -first, 0.02);
  EXPECT_NEAR(first, -0.02, 0.003);
  EXPECT_EQ(run("again").second, hash);
}

TEST_F(BagMapsTest, TakeEachOthersPlaceWhenTheirTimeComes)
{
  write(floorAt(-0.02, 99.0));
  write(floorAt(-0.04, 100.2));
  octomap_msgs::Octomap broken = floorAt(-0.02, 100.3);
  broken.data.resize(broken.data.size() / 2);
  write(broken);
  const auto [depth, hash] = run("lower");
  EXPECT_NEAR(depth, -0.04, 0.004);
}

TEST_F(BagMapsTest, AreWhereTfHasTheirFrame)
{
  geometry_msgs::TransformStamped lowered;
  lowered.header.frame_id = "world";
  lowered.child_frame_id = "camera";
  lowered.transform.translation.z = -0.03;
  lowered.transform.rotation.w = 1.0;
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(lowered);
  bag_.write("/tf_static", ros::Time(100.0), tf);
  write(floorAt(0.0, 100.0, "camera"));
  write(floorAt(0.0, 100.1, "nowhere"));
  EXPECT_NEAR(run("frame").first, -0.03, 0.004);
}

}  // namespace
}  // namespace soft_tissue_sim
