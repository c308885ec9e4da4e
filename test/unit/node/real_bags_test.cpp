// Bags that others recorded, or spoilt, each as its source says what it is.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/bag_poses.h"
#include "soft_tissue_sim/node/command_check.h"

namespace soft_tissue_sim
{
namespace
{
class RealBags : public testing::Test
{
 protected:
  void SetUp() override
  {
    const char* data = std::getenv("SOFT_TISSUE_DATA");
    if (data == nullptr)
    {
      GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
    }
    folder_ = std::string(data) + "/bags";
  }

  BagPoses follow(const std::string& name, const std::string& frame) const
  {
    soft_tissue::ToolConfig tool;
    tool.name = "probe";
    tool.pose_source.kind = soft_tissue::PoseSourceConfig::Kind::tf;
    tool.pose_source.name = frame;
    return readBagPoses(folder_ + "/" + name, {tool}, "world");
  }

  std::string complaintOf(const std::string& name) const
  {
    soft_tissue::ToolConfig tool;
    tool.name = "probe";
    try
    {
      readBagPoses(folder_ + "/" + name, {tool}, "world");
      return "";
    }
    catch (const soft_tissue::Error& error)
    {
      return error.what();
    }
  }

  std::string folder_;
};

TEST_F(RealBags, thatHaveNothingOfUseAreRefusedAndSayWhy)
{
  const std::map<std::string, std::string> reasons{
      {"asci-file.txt", "is not a readable bag"},
      {"empty-file.bag", "is not a readable bag"},
      {"no-messages.bag", "it has no topics"},
      {"example-unsorted-chunks.bag", "it has foo (std_msgs/String)"},
      {"example.bag", "/turtle1/pose (turtlesim/Pose)"},
      {"example-bz2.bag", "/turtle1/pose (turtlesim/Pose)"},
      {"example-lz4.bag", "/turtle1/pose (turtlesim/Pose)"}};
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
  {
    EXPECT_EQ(reasons.count(entry.path().filename().string()), 1u) << entry.path() << " is new";
  }
  for (const auto& [name, reason] : reasons)
  {
    const std::string said = complaintOf(name);
    EXPECT_NE(said.find(name), std::string::npos) << said;
    EXPECT_NE(said.find(reason), std::string::npos) << said;
  }
}

TEST_F(RealBags, aRecordedFrameIsFollowedWithoutLoss)
{
  // The field of these turtles is 11 m wide: where they are too far away the node refuses them.
  const BagTool turtle = follow("example.bag", "turtle1").tools[0];
  ASSERT_EQ(turtle.counts.size(), 1u);
  EXPECT_EQ(turtle.counts[0].messages, 1344u);
  EXPECT_EQ(turtle.counts[0].out_of_order, 0u);
  ASSERT_EQ(turtle.counts[0].rejected.size(), 1u);
  EXPECT_EQ(turtle.counts[0].rejected.begin()->first, rejectionText(Rejection::too_far));
  EXPECT_EQ(turtle.counts[0].used + turtle.counts[0].rejected.begin()->second, 1344u);
  EXPECT_EQ(turtle.poses.samples.size(), turtle.counts[0].used);
  EXPECT_GT(turtle.counts[0].used, 900u);
  for (std::size_t i = 0; i < turtle.poses.samples.size(); ++i)
  {
    EXPECT_LE(turtle.poses.samples[i].translation().norm(), 10.0);
    EXPECT_TRUE(i == 0 || turtle.poses.times_s[i - 1] < turtle.poses.times_s[i]);
  }
}

TEST_F(RealBags, aFrameAtTheEndOfALatchedTransformIsFollowed)
{
  const BagTool turtle = follow("example.bag", "turtle1").tools[0];
  const BagTool carrot = follow("example.bag", "carrot").tools[0];
  std::map<double, soft_tissue::Pose> turtles;
  for (std::size_t i = 0; i < turtle.poses.samples.size(); ++i)
  {
    turtles[turtle.poses.times_s[i]] = turtle.poses.samples[i];
  }
  std::size_t both = 0;
  for (std::size_t i = 0; i < carrot.poses.samples.size(); ++i)
  {
    const auto there = turtles.find(carrot.poses.times_s[i]);
    if (there != turtles.end())
    {
      ++both;
      const soft_tissue::Pose fixed(there->second.inverse() * carrot.poses.samples[i]);
      EXPECT_LT((fixed.translation() - soft_tissue::Vec3(1.0, 0.0, 0.0)).norm(), 1e-12) << i;
      EXPECT_TRUE(fixed.linear().isIdentity(1e-12)) << i;
    }
  }
  EXPECT_GT(both, 500u);
}

TEST_F(RealBags, compressionChangesNoBit)
{
  const BagTool plain = follow("example.bag", "turtle2").tools[0];
  for (const char* const name : {"example-lz4.bag", "example-bz2.bag"})
  {
    const BagTool same = follow(name, "turtle2").tools[0];
    EXPECT_EQ(same.poses.times_s, plain.poses.times_s) << name;
    ASSERT_EQ(same.poses.samples.size(), plain.poses.samples.size()) << name;
    for (std::size_t i = 0; i < plain.poses.samples.size(); ++i)
    {
      EXPECT_EQ(same.poses.samples[i].matrix(), plain.poses.samples[i].matrix()) << name;
    }
  }
}

}  // namespace
}  // namespace soft_tissue_sim
