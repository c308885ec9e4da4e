#include "soft_tissue_sim/scene/octomap_data.h"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <random>
#include <sstream>

#include "soft_tissue_sim/base/error.h"
#include "support/voxel_samples.h"
#include "support/voxel_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kSize = 0.005;
const CellBox kBox = {Cell(-9, -7, -5), Cell(8, 9, 10)};

OctomapConfig config()
{
  OctomapConfig octomap;
  octomap.topic = "octomap_in";
  octomap.resolution_m = kSize;
  return octomap;
}

bool isBall(const Vec3& p)
{
  return (p / kSize).norm() < 6.0;
}

template <typename Tree>
OctomapData dataOf(const Tree& tree, bool binary)
{
  std::ostringstream stream;
  binary ? tree.writeBinaryData(stream) : tree.writeData(stream);
  return {binary, tree.getTreeType(), tree.getResolution(), stream.str()};
}

std::string complaint(const OctomapData& data, const OctomapConfig& octomap = config())
{
  try
  {
    octomapCells(data, octomap);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "none";
}

TEST(OctomapData, TreesOfEveryKindTellTheSameCells)
{
  octomap::OcTree tree(kSize);
  fillTree(tree, kBox, isBall);
  octomap::ColorOcTree colours(kSize);
  fillTree(colours, kBox, isBall);
  const std::uint64_t expected = voxelsOf(kSize, kBox, isBall).contents();
  for (const bool binary : {false, true})
  {
    EXPECT_EQ(octomapCells(dataOf(tree, binary), config()).contents(), expected);
    EXPECT_EQ(octomapCells(dataOf(colours, binary), config()).contents(), expected);
  }
}

TEST(OctomapData, AnEmptyTreeSaysNothing)
{
  const OctomapData nothing = {true, "OcTree", kSize, ""};
  EXPECT_TRUE(octomapCells(nothing, config()).bounds().empty());
  OctomapConfig solid = config();
  solid.unknown_occupied = true;
  solid.depth = 14;
  EXPECT_TRUE(octomapCells(nothing, solid).occupied({3, 3, 3}));
  EXPECT_DOUBLE_EQ(octomapCells(nothing, solid).cellSize(), 4.0 * kSize);
}

// The loop that what goes out of one simulation and into another one makes.
TEST(OctomapData, WhatGoesOutComesBackIn)
{
  const VoxelSet ball = voxelsOf(kSize, kBox, isBall);
  VoxelSet known = ball;
  known.fill({Cell(-6, -6, -20), Cell(6, 6, -10)}, true);  // where it was
  for (const bool binary : {false, true})
  {
    const OctomapData data = octomapOf(ball, known, binary);
    EXPECT_EQ(octomapCells(data, config()).contents(), ball.contents()) << binary;
    OctomapConfig solid = config();
    solid.unknown_occupied = true;
    const VoxelSet back = octomapCells(data, solid);
    EXPECT_FALSE(back.occupied({0, 0, -15})) << "it left";
    EXPECT_TRUE(back.occupied({0, 0, 30})) << "nothing is said of that";
    EXPECT_TRUE(back.occupied({0, 0, 0}));
  }
}

TEST(OctomapData, LeavesOutWhatNoOctomapHas)
{
  VoxelSet cells(kSize);
  cells.set({32767, 0, 0}, true);
  cells.set({32768, 0, 0}, true);
  cells.set({0, -32769, 0}, true);
  const VoxelSet back = octomapCells(octomapOf(cells, cells, true), config());
  EXPECT_TRUE(back.occupied({32767, 0, 0}));
  EXPECT_FALSE(back.occupied({32768, 0, 0}) || back.occupied({-32768, 0, 0}));
}

TEST(OctomapData, TakesAResolutionOfSinglePrecision)
{
  OctomapData data = octomapOf(voxelsOf(kSize, kBox, isBall), VoxelSet(kSize), true);
  data.resolution = static_cast<float>(kSize);
  EXPECT_EQ(octomapCells(data, config()).cellSize(), kSize);
}

TEST(OctomapData, SaysWhatIsWrong)
{
  const OctomapData good = octomapOf(voxelsOf(kSize, kBox, isBall), VoxelSet(kSize), false);
  const auto changed = [&](const auto& change) {
    OctomapData data = good;
    change(data);
    return complaint(data);
  };
  EXPECT_EQ(complaint(good), "none");
  EXPECT_EQ(changed([](OctomapData& data) { data.id = "OcTreeStamped"; }),
            "id = 'OcTreeStamped', must be OcTree or ColorOcTree");
  EXPECT_EQ(changed([](OctomapData& data) { data.resolution = 0.01; }),
            "resolution = 0.01, must be the scene's, 0.005");
  EXPECT_EQ(changed([](OctomapData& data) { data.resolution = std::nan(""); }),
            "resolution = nan, must be the scene's, 0.005");
  EXPECT_EQ(changed([](OctomapData& data) { data.bytes += "abc"; }),
            "3 bytes follow its tree: damaged?");
  EXPECT_EQ(changed([](OctomapData& data) { data.bytes = std::string("\x06\0", 2); }),
            "ends within node 1 of its tree: truncated?");
  EXPECT_EQ(changed([](OctomapData& data) {
              data.binary = true;
              data.bytes = "\xaa\xaa";  // all of space
            }),
            "has more than 134217728 cells at this depth; a smaller depth takes larger ones");
}

// Cut anywhere, and with any byte changed, a message is refused or taken, never more.
TEST(OctomapData, SurvivesWhateverComes)
{
  std::mt19937 random(5);
  const VoxelSet ball = voxelsOf(kSize, kBox, isBall);
  int refused = 0;
  for (const bool binary : {false, true})
  {
    const OctomapData good = octomapOf(ball, ball, binary);
    for (std::size_t length = 1; length < good.bytes.size(); length += 7)
    {
      OctomapData cut = good;
      cut.bytes.resize(length);
      EXPECT_NE(complaint(cut), "none") << length;
    }
    for (int trial = 0; trial < 300; ++trial)
    {
      OctomapData bad = good;
      bad.bytes[random() % bad.bytes.size()] ^= static_cast<char>(1 + random() % 255);
      bad.id = trial % 2 == 0 ? "OcTree" : "ColorOcTree";
      bad.binary = trial % 3 == 0 ? !binary : binary;
      refused += complaint(bad) != "none";
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace soft_tissue::test
