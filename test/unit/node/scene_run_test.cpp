#include "soft_tissue_sim/node/scene_run.h"

#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <soft_tissue_sim/SimStats.h>

#include <algorithm>
#include <sstream>

#include "soft_tissue_sim/base/error.h"
#include "support/pressed_block.h"

namespace soft_tissue_sim
{
namespace
{
using namespace test;

class SceneRun : public testing::Test
{
 protected:
  RunOptions options(const std::string& name) const { return pressed_.options(name); }
  static std::string contents(const std::string& path) { return PressedBlock::contents(path); }

  PressedBlock pressed_;
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
  EXPECT_EQ(step, std::uint64_t{kPressedSteps});
  EXPECT_GT(force_z, 0.0);
  EXPECT_EQ(rosbag::View(bag, rosbag::TopicQuery("/sim_node/block/mesh")).size(), 1u);
}

TEST_F(SceneRun, anOutputBagServesAsInput)
{
  const RunOptions first = options("first");
  runScene(first);
  pressed_.write(5000.0, kPressingTopic);
  RunOptions second = options("second");
  second.bag_in = first.bag_out;
  runScene(second);
  rosbag::Bag bag(second.bag_out);
  rosbag::View poses(bag, rosbag::TopicQuery("/sim_node/probe/measured_cp"));
  EXPECT_EQ(poses.size(),
            static_cast<std::uint32_t>(kPressedSteps - 1));  // from the first pose to the last
}

TEST_F(SceneRun, twoRunsHaveTheBitsOfOne)
{
  const std::string state = pressed_.path("state");
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
  run.load_state = pressed_.scene();
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run = options("run");
  run.scene = SOURCE_DIR "/test/ros/block.yaml";  // moved by commands only
  EXPECT_THROW(runScene(run), soft_tissue::Error);
  run.bag_in = SOURCE_DIR "/test/ros/block.yaml";
  EXPECT_THROW(runScene(run), soft_tissue::Error);
}

// A run compared with its own bag is as far from it as the bag's forces are rounded: not at all.
TEST_F(SceneRun, comparesForcesWithThoseInTheBag)
{
  const RunOptions first = options("first");
  runScene(first);
  pressed_.write(5000.0, kPressingTopic);
  RunOptions second = options("second");
  second.bag_in = first.bag_out;
  second.compare = pressed_.path("compare.csv");
  runScene(second);
  std::istringstream lines(contents(second.compare));
  std::string line;
  int count = -1;  // the header
  while (std::getline(lines, line))
  {
    ++count;
  }
  EXPECT_EQ(count, kPressedSteps - 1);
  const std::string json = contents(second.json);
  const std::size_t error = json.find("\"relative_error\": ");
  ASSERT_NE(error, std::string::npos) << json;
  // The first run's ball is at its second step where the second run's is at its first.
  EXPECT_LT(std::stod(json.substr(error + 18)), 0.02) << json;
}

}  // namespace
}  // namespace soft_tissue_sim
