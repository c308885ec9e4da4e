#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <fstream>

#include "soft_tissue_sim/node/bag_poses.h"
#include "soft_tissue_sim/node/command_check.h"
#include "soft_tissue_sim/node/scene_run.h"
#include "soft_tissue_sim/node/scratch_folder.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Vec3;

geometry_msgs::TwistStamped twist(double stamp, const Vec3& linear, double turn,
                                  const std::string& frame)
{
  geometry_msgs::TwistStamped message;
  message.header.stamp = ros::Time(stamp);
  message.header.frame_id = frame;
  message.twist.linear.x = linear.x();
  message.twist.linear.y = linear.y();
  message.twist.linear.z = linear.z();
  message.twist.angular.z = turn;
  return message;
}

geometry_msgs::PoseStamped measured(double stamp, double x)
{
  geometry_msgs::PoseStamped message;
  message.header.stamp = ros::Time(stamp);
  message.pose.position.x = x;
  message.pose.orientation.w = 1.0;
  return message;
}

class BagTwists : public testing::Test
{
 protected:
  BagTwists()
  {
    tool_.name = "flyer";
    tool_.pose_source.kind = soft_tissue::PoseSourceConfig::Kind::twist;
    tool_.pose_source.name = "servo_cv";
    bag_.open(path(), rosbag::bagmode::Write);
  }

  std::string path() const { return folder_.path() + "/twists.bag"; }

  template <typename Message>
  void write(const std::string& topic, double recorded, const Message& message)
  {
    bag_.write(topic, ros::Time(recorded), message);
  }

  BagPoses read()
  {
    bag_.close();
    return readBagPoses(path(), {tool_}, "world");
  }

  /** Positions of the tool on the bag that running a scene with it leaves, a step of 5 ms each. */
  std::vector<geometry_msgs::Pose> replayed(double duration_s)
  {
    bag_.close();
    RunOptions options;
    options.scene = folder_.path() + "/scene.yaml";
    std::ofstream(options.scene)
        << "tissues:\n"
           "  - name: block\n"
           "    mesh: {file: " SOURCE_DIR
           "/test/ros/block.msh, length_unit: m}\n"
           "    material: {young_modulus_pa: 5000, poisson_ratio: 0.4, density_kg_per_m3: 1000}\n"
           "    fixed: [{box_m: [[-1, -1, -1], [1, 1, 1]]}]\n"
           "tools:\n"
           "  - name: flyer\n"
           "    shape: {sphere: {radius_m: 0.004}}\n"
           "    initial_pose: {position_m: [0, 0, 1]}\n"
           "    pose_source: {twist: servo_cv}\n";
    options.quiet = true;
    options.bag_in = path();
    options.bag_out = folder_.path() + "/out.bag";
    options.duration_s = duration_s;
    runScene(options);
    std::vector<geometry_msgs::Pose> poses;
    const rosbag::Bag out(options.bag_out);
    for (const rosbag::MessageInstance& one :
         rosbag::View(out, rosbag::TopicQuery("/sim_node/flyer/measured_cp")))
    {
      poses.push_back(one.instantiate<geometry_msgs::PoseStamped>()->pose);
    }
    return poses;
  }

  ScratchFolder folder_;
  soft_tissue::ToolConfig tool_;
  rosbag::Bag bag_;
};

TEST_F(BagTwists, areReadInTheWorldsAxesAndCounted)
{
  tf2_msgs::TFMessage quarter;
  quarter.transforms.resize(1);
  quarter.transforms[0].header.frame_id = "world";
  quarter.transforms[0].child_frame_id = "camera";
  quarter.transforms[0].transform.translation.x = 5.0;
  quarter.transforms[0].transform.rotation.z = quarter.transforms[0].transform.rotation.w =
      std::sqrt(0.5);
  write("/tf_static", 1.0, quarter);
  write("/a/flyer/servo_cv", 1.0, twist(1.0, Vec3(1, 0, 0), 0.0, "camera"));
  write("/a/flyer/servo_cv", 1.1, twist(1.1, Vec3(1, 0, 0), 0.0, "flyer"));
  write("/a/flyer/servo_cv", 1.2, twist(1.2, Vec3(1, 0, 0), 0.0, "nowhere"));
  write("/a/flyer/servo_cv", 1.3, twist(1.3, Vec3(1, 0, 0), std::nan(""), ""));
  write("/a/flyer/servo_cv", 1.4, twist(1.4, Vec3(1, 0, 0), 0.0, ""));
  write("/a/flyer/servo_cv", 1.5, twist(1.4, Vec3(2, 0, 0), 0.0, ""));
  const BagPoses poses = read();
  const TwistSeries& twists = poses.tools[0].twists;
  ASSERT_EQ(twists.times_s.size(), 3u);
  EXPECT_LT((twists.samples[0].linear - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_TRUE(twists.samples[1].in_own_axes);
  EXPECT_EQ(twists.samples[2].linear, Vec3(2, 0, 0));
  EXPECT_FALSE(poses.tools[0].first_pose);
  EXPECT_DOUBLE_EQ(poses.length_s, 0.4);
  ASSERT_EQ(poses.tools[0].counts.size(), 1u);
  EXPECT_EQ(poses.tools[0].counts[0].of, "twist");
  EXPECT_EQ(poses.tools[0].counts[0].messages, 6u);
  EXPECT_EQ(poses.tools[0].counts[0].used, 3u);
  const std::map<std::string, std::size_t> reasons{{rejectionText(Rejection::unknown_frame), 1},
                                                   {rejectionText(Rejection::not_finite), 1},
                                                   {"another one after it has the same stamp", 1}};
  EXPECT_EQ(poses.tools[0].counts[0].rejected, reasons);
}

TEST_F(BagTwists, beginWhereTheToolWasMeasuredThen)
{
  write("/flyer/measured_cp", 1.0, measured(1.0, 0.1));
  write("/flyer/measured_cp", 3.0, measured(3.0, 0.3));
  write("/flyer/servo_cv", 2.0, twist(2.0, Vec3(1, 0, 0), 0.0, ""));
  const BagPoses poses = read();
  EXPECT_EQ(poses.start, ros::Time(2.0));
  EXPECT_TRUE(poses.tools[0].poses.empty());
  ASSERT_TRUE(poses.tools[0].first_pose);
  EXPECT_NEAR(poses.tools[0].first_pose->translation().x(), 0.2, 1e-15);
}

TEST_F(BagTwists, withoutAnyWhereItWasMeasuredServes)
{
  write("/flyer/measured_cp", 1.0, measured(1.0, 0.1));
  write("/flyer/measured_cp", 3.0, measured(3.0, 0.3));
  const BagPoses poses = read();
  EXPECT_EQ(poses.tools[0].poses.times_s, (std::vector<double>{0.0, 2.0}));
  EXPECT_TRUE(poses.tools[0].twists.empty());
}

TEST_F(BagTwists, everyOneOfAFastStreamIsIntegrated)
{
  // 1 kHz and steps of 5 ms: v(t) = cos 2 pi t, held for a millisecond each.
  double sum = 0.0;
  for (int i = 0; i < 1000; ++i)
  {
    const double v = 0.1 * std::cos(2e-3 * M_PI * i);
    write("/flyer/servo_cv", 1.0 + 1e-3 * i, twist(1.0 + 1e-3 * i, Vec3(v, 0, 0), 0.0, "world"));
    sum += i < 730 ? 1e-3 * v : 0.0;
  }
  const std::vector<geometry_msgs::Pose> poses = replayed(0.73);
  ASSERT_EQ(poses.size(), 146u);
  EXPECT_NEAR(poses.back().position.x, sum, 1e-12);
  EXPECT_NEAR(poses.back().position.z, 1.0, 1e-15);
}

TEST_F(BagTwists, inItsOwnAxesATurningToolGoesRoundInACircle)
{
  // Straight on by v and turned by w at once, a full circle of radius v / w in a second.
  for (int i = 0; i <= 100; ++i)
  {
    write("/flyer/servo_cv", 1.0 + 0.01 * i,
          twist(1.0 + 0.01 * i, Vec3(0.1, 0, 0), 2.0 * M_PI, "flyer"));
  }
  const std::vector<geometry_msgs::Pose> poses = replayed(1.0);
  ASSERT_EQ(poses.size(), 200u);
  const double radius = 0.1 / (2.0 * M_PI);
  EXPECT_NEAR(poses[99].position.y, 2.0 * radius, 1e-3 * radius);
  EXPECT_LT(std::hypot(poses[199].position.x, poses[199].position.y), 1e-12);
  EXPECT_NEAR(std::abs(poses[199].orientation.w), 1.0, 1e-12);
}

TEST_F(BagTwists, stopCountingAfterASilenceAsInTheNode)
{
  write("/flyer/servo_cv", 1.0, twist(1.0, Vec3(0.1, 0, 0), 0.0, "world"));
  write("/flyer/servo_cv", 3.0, twist(3.0, Vec3(0.1, 0, 0), 0.0, "world"));
  const std::vector<geometry_msgs::Pose> poses = replayed(2.1);
  ASSERT_EQ(poses.size(), 420u);
  EXPECT_NEAR(poses[99].position.x, 0.05, 1e-12);
  EXPECT_NEAR(poses[399].position.x, 0.05, 1e-12);
  EXPECT_NEAR(poses[419].position.x, 0.06, 1e-12);
}

}  // namespace
}  // namespace soft_tissue_sim
