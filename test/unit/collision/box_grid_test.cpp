#include "soft_tissue_sim/collision/box_grid.h"

#include <gtest/gtest.h>

#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
namespace
{
std::vector<Box3> randomBoxes(int count, RandomGeometry& random, double size)
{
  std::vector<Box3> boxes(count);
  for (Box3& box : boxes)
  {
    const Vec3 centre = random.point(1.0);
    box.extend(centre + random.point(size));
    box.extend(centre + random.point(size));
  }
  return boxes;
}

void expectAllFoundOnce(const BoxGrid& grid, const std::vector<Box3>& boxes, const Box3& query)
{
  std::vector<int> visits(boxes.size(), 0);
  grid.forEachOverlap(query, [&](Index i) { ++visits[i]; });
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    EXPECT_EQ(visits[i], boxes[i].overlaps(query) ? 1 : 0) << "box " << i;
  }
}
}  // namespace

TEST(BoxGrid, FindsEveryOverlapOnce)
{
  RandomGeometry random(1);
  BoxGrid grid;
  for (const int count : {1, 2, 30, 700})  // one grid built again and again
  {
    const std::vector<Box3> boxes = randomBoxes(count, random, 0.1);
    grid.build(boxes);
    for (const Box3& query : randomBoxes(50, random, 0.5))
    {
      expectAllFoundOnce(grid, boxes, query);
    }
    for (const Box3& query : boxes)
    {
      expectAllFoundOnce(grid, boxes, query);
    }
  }
}

TEST(BoxGrid, HoldsPointsInAPlane)
{
  std::vector<Box3> boxes(50);
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    boxes[i].extend(Vec3(0.1 * double(i % 7), 0.2 * double(i / 7), 3.0));
  }
  BoxGrid grid;
  grid.build(boxes);
  expectAllFoundOnce(grid, boxes, boxes[13]);
  expectAllFoundOnce(grid, boxes, grid.bounds());
}

TEST(BoxGrid, FindsNothingWithAnEmptyOrNonFiniteBox)
{
  RandomGeometry random(2);
  BoxGrid grid;
  grid.build(randomBoxes(20, random, 0.1));
  Box3 nan;
  nan.min.setConstant(std::nan(""));
  nan.max.setConstant(std::nan(""));
  int visits = 0;
  grid.forEachOverlap(nan, [&](Index) { ++visits; });
  grid.forEachOverlap(Box3(), [&](Index) { ++visits; });
  grid.build({});
  grid.forEachOverlap(randomBoxes(1, random, 1.0)[0], [&](Index) { ++visits; });
  EXPECT_EQ(visits, 0);
}

}  // namespace soft_tissue::test
