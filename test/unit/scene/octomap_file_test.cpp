#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>

#include <cstdlib>
#include <fstream>

#include "soft_tissue_sim/base/error.h"
#include "support/geometry_oracle.h"
#include "support/voxel_scenes.h"

namespace soft_tissue::test
{
namespace
{
const CellBox kBlock = {Cell(-40, -40, -8), Cell(40, 40, 16)};

/** Under the tissue, but for a bump that keeps the cells apart. */
bool isFloor(const Vec3& p)
{
  return p.z() < (p.x() > 0.0 ? -0.005 : -0.010);
}

class OctomapFile : public testing::Test
{
 protected:
  OctomapFile() : config_(blockScene(folder_, {2, 2, 1})) {}

  /** What building the scene with this file complains of, its path as FILE. */
  std::string complaint(const std::string& file)
  {
    SceneConfig config = config_;
    addMap(config, file, Response::segment);
    config.obstacles[0].octomap.unknown_occupied = unknown_occupied_;
    try
    {
      Scene scene(config);
    }
    catch (const Error& error)
    {
      std::string text = error.what();
      const std::size_t at = text.find(file);
      return at == std::string::npos ? text : text.replace(at, file.size(), "FILE");
    }
    return "none";
  }

  std::string write(const std::string& text)
  {
    const std::string file = folder_.path("bad.bt");
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

  /** Height of the surface that a scene shows, under the tissue. */
  double top(const OctomapConfig& octomap)
  {
    SceneConfig config = config_;
    addMap(config, octomap.file, Response::segment);
    config.obstacles[0].octomap = octomap;
    const Scene scene(config);
    double top = -1.0;
    for (const Vec3& node : scene.obstacles()[0].surface.nodes)
    {
      top = std::max(top, node.z());
    }
    return top;
  }

  ScratchFolder folder_;
  SceneConfig config_;
  bool unknown_occupied_ = false;
};

const std::string kWhere = "small scene: obstacles[0].octomap.file = FILE, ";
const std::string kHeader = "# Octomap OcTree binary file\nid OcTree\nsize 2\nres 0.1\ndata\n";

TEST_F(OctomapFile, ReadsEveryKindOfFileAlike)
{
  octomap::OcTree tree(0.005);
  fillTree(tree, kBlock, isFloor);
  octomap::ColorOcTree colours(0.005);
  fillTree(colours, kBlock, isFloor);
  ASSERT_TRUE(tree.writeBinary(folder_.path("a.bt")));
  ASSERT_TRUE(tree.write(folder_.path("a.ot")));
  ASSERT_TRUE(colours.write(folder_.path("b.ot")));
  for (const char* name : {"a.bt", "a.ot", "b.ot"})
  {
    OctomapConfig octomap;
    octomap.file = folder_.path(name);
    EXPECT_NEAR(top(octomap), -0.005, 1e-12) << name;
  }
}

TEST_F(OctomapFile, CellsOfLessDepthAreOccupiedWhereAnythingInThemIs)
{
  OctomapConfig octomap;
  octomap.file = savedMap(folder_, 0.005, kBlock, isFloor);
  for (const bool unknown_occupied : {false, true})
  {
    octomap.unknown_occupied = unknown_occupied;
    octomap.depth = 15;  // cells of 10 mm, up to z = 0
    EXPECT_NEAR(top(octomap), unknown_occupied ? 0.09 : 0.0, 0.011);
  }
}

TEST_F(OctomapFile, UnknownCellsAreWhatTheSceneSays)
{
  const auto free = [](const Vec3&) { return false; };
  const std::string file = savedMap(folder_, 0.01, {Cell(-5, -5, -1), Cell(5, 5, 6)}, free);
  EXPECT_EQ(complaint(file), kWhere + "has no occupied cells");
  OctomapConfig octomap;
  octomap.file = file;
  octomap.unknown_occupied = true;
  EXPECT_NEAR(top(octomap), 0.06, 0.004) << "the ceiling of the free room";
  config_.tissues[0].pose.position_m.x() = 0.5;
  unknown_occupied_ = true;
  EXPECT_NE(complaint(file).find("obstacles[0] 'map': tissue 'tissue' starts "), std::string::npos)
      << "nothing is known of the place it stands in";
}

TEST_F(OctomapFile, RefusesTissueThatStartsInside)
{
  const std::string file = savedMap(folder_, 0.005, kBlock, isFloor);
  EXPECT_EQ(complaint(file), "none");
  config_.tissues[0].pose.position_m.z() = -0.02;
  const std::string said = complaint(file);
  EXPECT_NE(said.find("small scene: obstacles[0] 'map': tissue 'tissue' starts 15.0"),
            std::string::npos)
      << said;
}

TEST_F(OctomapFile, RefusesWhatIsNoOctomapOrDamaged)
{
  const std::vector<std::array<std::string, 2>> bad = {
      {"",
       "is no OctoMap: its first line must be '# Octomap OcTree binary file' or '# Octomap "
       "OcTree file' (octomap-tools' convert_octree updates files from before 1.0)"},
      {"# Octomap OcTree file\nid OcTree\nres 0.1\ndata\n",
       "header: must have id, size, res and data"},
      {"# Octomap OcTree file\nid OcTree\nsize 0\nres 0.1\n",
       "header: must have id, size, res and data"},
      {"# Octomap OcTree file\nid OcTree\nsize many\nres 0.1\ndata\n",
       "header: 'size' = 'many', must be a number"},
      {"# Octomap OcTree file\nid OcTree\nsize 1\nres 0\ndata\n",
       "header: res = 0, must be above 0"},
      {"# Octomap OcTree file\nid OcTree\nsize 1\nres -0.1\ndata\n",
       "header: res = -0.1, must be above 0"},
      {"# Octomap OcTree file\nid CountingOcTree\nsize 1\nres 0.1\ndata\n",
       "header: id = CountingOcTree, must be OcTree or ColorOcTree"},
      {"# Octomap OcTree file\nid OcTree\nsize 0\nres 0.1\ndata\n", "has no occupied cells"},
      {kHeader, "ends within node 1 of its tree: truncated?"},
      {kHeader + "\x03", "ends within node 1 of its tree: truncated?"},
      {kHeader + std::string("\x03\0", 2), "ends within node 2 of its tree: truncated?"},
      {kHeader + std::string("\x06\0", 2), "header: size = 2, but its tree has 3 nodes: damaged?"},
      {kHeader + std::string(64, '\xff'), "node 16 has children below depth 16: damaged?"},
  };
  for (const auto& [text, expected] : bad)
  {
    EXPECT_EQ(complaint(write(text)), kWhere + expected);
  }
  EXPECT_EQ(complaint(folder_.path("gone.bt")), kWhere + "can't be read");
}

TEST_F(OctomapFile, RefusesMoreCellsThanMemoryShouldHold)
{
  // The root's eight children, all occupied: the whole of space.
  const std::string all =
      "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\n\xaa\xaa";
  EXPECT_EQ(complaint(write(all)),
            kWhere +
                "has more than 134217728 cells at this depth; a smaller depth takes larger "
                "ones");
}

TEST_F(OctomapFile, ReadsMapsOfOthers)
{
  const char* data = std::getenv("SOFT_TISSUE_DATA");
  if (data == nullptr)
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  const std::string folder = std::string(data) + "/octomap/";
  EXPECT_NE(complaint(folder + "simple_2010_legacy.bt").find("is no OctoMap"), std::string::npos);
  config_.tissues[0].pose.position_m = Vec3(0.0, 0.0, 30.0);  // above the maps
  for (const char* name :
       {"geb079.bt", "spherical_scan_res005_derived.bt", "spherical_scan_res005_derived.ot"})
  {
    EXPECT_EQ(complaint(folder + name), "none") << name;
  }
}

}  // namespace
}  // namespace soft_tissue::test
