#include "soft_tissue_sim/node/scene_run.h"

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <soft_tissue_sim/SimStats.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/scratch_folder.h"

namespace soft_tissue_sim
{
namespace
{
constexpr int kSteps = 40;

class SceneRun : public testing::Test
{
 protected:
  SceneRun()
  {
    std::ofstream(scene())
        << "time_step_s: 0.01\n"
           "tissues:\n"
           "  - name: block\n"
           "    mesh: {file: " SOURCE_DIR
           "/test/ros/block.msh, length_unit: m}\n"
           "    material: {model: neo_hookean, young_modulus_pa: 5000, poisson_ratio: 0.4,\n"
           "               density_kg_per_m3: 1000}\n"
           "    fixed: [{box_m: [[-1, -1, -0.001], [1, 1, 0.001]]}]\n"
           "tools:\n"
           "  - name: probe\n"
           "    shape: {sphere: {radius_m: 0.008}}\n"
           "    pose_source:\n"
           "      keyframes:\n"
           "        - {time_s: 0, position_m: [0, 0, 0.04]}\n"
           "        - {time_s: 0.4, position_m: [0, 0, 0.035]}\n"
           "contacts: [{between: [block, probe]}]\n";
  }

  std::string scene() const { return folder_.path() + "/scene.yaml"; }

  RunOptions options(const std::string& name) const
  {
    RunOptions options;
    options.scene = scene();
    options.quiet = true;
    options.bag_out = folder_.path() + "/" + name + ".bag";
    options.csv = folder_.path() + "/" + name + ".csv";
    options.json = folder_.path() + "/" + name + ".json";
    return options;
  }

  static std::string contents(const std::string& path)
  {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  ScratchFolder folder_;
};

TEST_F(SceneRun, writesTheSameBytesForAnyNumberOfThreads)
{
  RunOptions one = options("one");
  one.threads = 1;
  runScene(one);
  RunOptions two = options("two");
  two.threads = 2;
  runScene(two);
  EXPECT_EQ(contents(one.csv), contents(two.csv));
  EXPECT_TRUE(contents(one.bag_out) == contents(two.bag_out));
  EXPECT_GT(contents(one.bag_out).size(), 10000u);
}

TEST_F(SceneRun, recordsEveryStepUpToTheLastKeyFrame)
{
  const RunOptions run = options("run");
  runScene(run);
  rosbag::Bag bag(run.bag_out);
  std::uint64_t step = 0;
  double force_z = 0.0;
  for (const rosbag::MessageInstance& message : rosbag::View(bag))
  {
    if (const auto stats = message.instantiate<SimStats>())
    {
      EXPECT_EQ(stats->step, ++step);
      EXPECT_NEAR(stats->header.stamp.toSec(), 0.01 * static_cast<double>(step), 1e-8);
    }
    if (message.getTopic() == "/sim_node/probe/spatial/measured_cf")
    {
      force_z = message.instantiate<geometry_msgs::WrenchStamped>()->wrench.force.z;
    }
  }
  EXPECT_EQ(step, std::uint64_t{kSteps});
  EXPECT_GT(force_z, 0.0);
  EXPECT_EQ(rosbag::View(bag, rosbag::TopicQuery("/sim_node/block/mesh")).size(), 1u);
}

TEST_F(SceneRun, anOutputBagServesAsInput)
{
  const RunOptions first = options("first");
  runScene(first);
  std::string text = contents(scene());
  text.replace(text.find("    pose_source:"), std::string::npos,
               "    pose_source: {topic: servo_cp}\n"
               "contacts: [{between: [block, probe]}]\n");
  std::ofstream(scene()) << text;
  RunOptions second = options("second");
  second.bag_in = first.bag_out;
  runScene(second);
  rosbag::Bag bag(second.bag_out);
  rosbag::View poses(bag, rosbag::TopicQuery("/sim_node/probe/measured_cp"));
  EXPECT_EQ(poses.size(),
            static_cast<std::uint32_t>(kSteps - 1));  // from the first pose to the last
}

TEST_F(SceneRun, twoRunsHaveTheBitsOfOne)
{
  const std::string state = folder_.path() + "/state";
  const RunOptions whole = options("whole");
  runScene(whole);
  RunOptions first = options("first");
  first.duration_s = 0.17;
  first.save_state = state;
  runScene(first);
  RunOptions second = options("second");
  second.load_state = state;
  second.save_state = state;
  runScene(second);
  const std::string lines = contents(whole.csv), head = contents(first.csv);
  const std::string tail = contents(second.csv);
  const std::string titles = tail.substr(0, tail.find('\n') + 1);
  EXPECT_EQ(head + tail.substr(titles.size()), lines);
  second.duration_s = 0.05;  // beyond the last key frame
  runScene(second);
  const std::string more = contents(second.csv);
  EXPECT_EQ(std::count(more.begin(), more.end(), '\n'), 6);
}

TEST_F(SceneRun, refusesWhatCannotBeWrittenOrHasNoEnd)
{
  RunOptions run = options("run");
  run.csv = "/nowhere/run.csv";
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run = options("run");
  run.bag_out = "/nowhere/run.bag";
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run = options("run");
  run.json = "/nowhere/run.json";
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run = options("run");
  run.save_state = "/nowhere/state";
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run = options("run");
  run.load_state = scene();
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run = options("run");
  run.scene = SOURCE_DIR "/test/ros/block.yaml";  // moved by commands only
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run.bag_in = SOURCE_DIR "/test/ros/block.yaml";
  EXPECT_THROW(runScene(run), soft_tissue::Error);
}

}  // namespace
}  // namespace soft_tissue_sim
