#include "soft_tissue_sim/geometry/voxel_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "soft_tissue_sim/base/error.h"
#include "support/voxel_samples.h"

namespace soft_tissue
{
namespace
{
class VoxelSetOf : public testing::TestWithParam<bool>
{};

INSTANTIATE_TEST_SUITE_P(OtherCells, VoxelSetOf, testing::Bool());

TEST_P(VoxelSetOf, KnowsWhatAListOfCellsKnows)
{
  const bool others = GetParam();
  VoxelSet cells(0.5, others);
  std::set<std::array<int, 3>> unlike;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> index(-20, 20), side(0, 9), coin(0, 2);
  for (int k = 0; k < 60; ++k)
  {
    const Cell low(index(random), index(random), index(random));
    const CellBox box = {low, low + Cell(side(random), side(random), side(random))};
    const bool occupied = coin(random) > 0;
    cells.fill(box, occupied);
    for (int z = box.low.z(); z < box.high.z(); ++z)
    {
      for (int y = box.low.y(); y < box.high.y(); ++y)
      {
        for (int x = box.low.x(); x < box.high.x(); ++x)
        {
          if (occupied != others)
          {
            unlike.insert({x, y, z});
          }
          else
          {
            unlike.erase({x, y, z});
          }
        }
      }
    }
  }
  ASSERT_GT(unlike.size(), 100u);
  const CellBox all = {Cell::Constant(-31), Cell::Constant(31)};
  std::vector<std::uint8_t> read;
  cells.read(all, read);
  std::size_t at = 0;
  for (int z = -31; z < 31; ++z)
  {
    for (int y = -31; y < 31; ++y)
    {
      for (int x = -31; x < 31; ++x, ++at)
      {
        const bool expected = others != (unlike.count({x, y, z}) > 0);
        ASSERT_EQ(cells.occupied({x, y, z}), expected) << x << ' ' << y << ' ' << z;
        ASSERT_EQ(read[at] != 0, expected) << x << ' ' << y << ' ' << z;
      }
    }
  }
}

TEST(VoxelSet, FindsTheCellOfAPoint)
{
  const VoxelSet cells(0.25);
  EXPECT_EQ(cells.cellOf({0.3, -0.1, 0.0}), Cell(1, -1, 0));
  EXPECT_EQ(cells.occupied(cells.cellOf(Vec3::Constant(1e300))), false);
  EXPECT_EQ(cells.occupied(cells.cellOf(Vec3::Constant(std::nan("")))), false);
}

TEST(VoxelSet, TakesMemoryForWhatItWasToldOnly)
{
  VoxelSet cells(0.01);
  cells.set({-100000, 0, 0}, true);
  cells.set({100000, 0, 0}, true);
  EXPECT_LT(cells.bytes(), 1000u);
}

TEST(VoxelSet, RefusesSizesAndIndicesWithoutMeaning)
{
  for (const double size : {0.0, -1.0, std::nan(""), 1.0 / 0.0})
  {
    EXPECT_THROW(VoxelSet{size}, Error) << size;
  }
  VoxelSet cells(1.0);
  EXPECT_THROW(cells.set({1 << 20, 0, 0}, true), Error);
}

// However they came to it, sets of the same cells have the same contents, and others do not.
TEST(VoxelSet, ContentsTellSetsApart)
{
  const CellBox box = {Cell(-9, -3, -12), Cell(7, 5, 4)};
  const VoxelSet cells = test::randomVoxels(21, box, 0.5);
  VoxelSet other(1.0);
  other.fill(box, true);
  for (int z = box.high.z() - 1; z >= box.low.z(); --z)
  {
    for (int y = box.low.y(); y < box.high.y(); ++y)
    {
      for (int x = box.low.x(); x < box.high.x(); ++x)
      {
        if (!cells.occupied({x, y, z}))
        {
          other.set({x, y, z}, false);
        }
      }
    }
  }
  EXPECT_EQ(cells.contents(), other.contents());
  EXPECT_TRUE(cells.difference(other, box).empty());
  std::set<std::uint64_t> seen = {cells.contents()};
  for (int x = box.low.x(); x < box.high.x(); ++x)
  {
    VoxelSet one = cells;
    one.set({x, 1, 1}, !cells.occupied({x, 1, 1}));
    EXPECT_TRUE(seen.insert(one.contents()).second);
    EXPECT_EQ(one.difference(cells, box).low, Cell(x, 1, 1));
    EXPECT_EQ(one.difference(cells, box).high, Cell(x + 1, 2, 2));
  }
}

TEST(VoxelSet, DiffersWhereTheOthersAreOccupied)
{
  VoxelSet free(1.0), solid(1.0, true);
  free.fill({Cell::Zero(), Cell::Constant(3)}, true);
  const CellBox box = {Cell::Constant(-2), Cell::Constant(5)};
  EXPECT_EQ(free.difference(solid, box).low, box.low);
  EXPECT_TRUE(free.difference(solid, {Cell::Zero(), Cell::Constant(3)}).empty());
}

}  // namespace
}  // namespace soft_tissue
