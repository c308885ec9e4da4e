#include "soft_tissue_sim/geometry/aabb_tree.h"

#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"
#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

std::vector<Box3> randomBoxes(RandomGeometry& random, int count)
{
  std::vector<Box3> boxes(count);
  for (Box3& box : boxes)
  {
    box.extend(random.point(1.0));
    box.extend(Vec3(box.min + 0.1 * random.point(1.0)));
  }
  return boxes;
}

void expectQueriesMatchBruteForce(const AabbTree& tree, const std::vector<Box3>& boxes,
                                  RandomGeometry& random)
{
  for (int trial = 0; trial < 50; ++trial)
  {
    Box3 asked;
    asked.extend(random.point(1.2));
    asked.extend(random.point(1.2));
    std::vector<Index> found;
    tree.query(asked, [&](Index item) { found.push_back(item); });
    std::sort(found.begin(), found.end());
    std::vector<Index> expected;
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      if (boxes[i].overlaps(asked))
      {
        expected.push_back(static_cast<Index>(i));
      }
    }
    EXPECT_EQ(found, expected);

    const Vec3 p = random.point(2.0);
    found.clear();
    expected.clear();
    tree.forEachWithin(p, 0.3, [&](Index item) { found.push_back(item); });
    std::sort(found.begin(), found.end());
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      if (boxes[i].squaredDistance(p) <= 0.3)
      {
        expected.push_back(static_cast<Index>(i));
      }
    }
    EXPECT_EQ(found, expected);

    const auto squared = [&](Index item) { return boxes[item].squaredDistance(p); };
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
      least = std::min(least, squared(static_cast<Index>(i)));
    }
    const Index nearest = tree.closest(p, squared);
    ASSERT_GE(nearest, 0);
    EXPECT_EQ(squared(nearest), least);
    EXPECT_EQ(tree.closest(p, squared, least), -1);
  }
}

class AabbTreeOfSize : public testing::TestWithParam<int>
{};

TEST_P(AabbTreeOfSize, FindsWhatBruteForceFindsAlsoAfterRefit)
{
  RandomGeometry random(GetParam());
  std::vector<Box3> boxes = randomBoxes(random, GetParam());
  AabbTree tree;
  tree.build(boxes);
  expectQueriesMatchBruteForce(tree, boxes, random);
  boxes = randomBoxes(random, GetParam());
  tree.refit(boxes);
  expectQueriesMatchBruteForce(tree, boxes, random);
}

INSTANTIATE_TEST_SUITE_P(Sizes, AabbTreeOfSize, testing::Values(1, 2, 3, 7, 64, 500));

TEST(AabbTree, HandlesManyEqualBoxes)
{
  const std::vector<Box3> boxes(1000, Box3{Vec3::Zero(), Vec3::Ones()});
  AabbTree tree;
  tree.build(boxes);
  int count = 0;
  tree.query(boxes[0], [&](Index) { ++count; });
  EXPECT_EQ(count, 1000);
}

TEST(AabbTree, EmptyTreeFindsNothing)
{
  AabbTree tree;
  tree.build({});
  tree.query(Box3{Vec3::Zero(), Vec3::Ones()}, [](Index) { FAIL(); });
  EXPECT_EQ(tree.closest(Vec3::Zero(), [](Index) { return 0.0; }), -1);
  EXPECT_TRUE(tree.empty());
  EXPECT_GT(tree.bounds().min.x(), tree.bounds().max.x());
}

TEST(AabbTree, RejectsBoxesThatAreNotFinite)
{
  AabbTree tree;
  std::vector<Box3> boxes(2, Box3{Vec3::Zero(), Vec3::Ones()});
  boxes[1].max.y() = NAN;
  EXPECT_THROW(tree.build(boxes), Error);
  boxes[1].max.y() = INFINITY;
  EXPECT_THROW(tree.build(boxes), Error);
}

TEST(AabbTree, RejectsARefitWithAnotherNumberOfBoxes)
{
  AabbTree tree;
  tree.build(std::vector<Box3>(3, Box3{Vec3::Zero(), Vec3::Ones()}));
  EXPECT_THROW(tree.refit(std::vector<Box3>(2, Box3{Vec3::Zero(), Vec3::Ones()})), Error);
}

TEST(Box3, DistanceIsZeroInsideAndEuclideanOutside)
{
  const Box3 box{Vec3::Zero(), Vec3::Ones()};
  EXPECT_EQ(box.squaredDistance({0.5, 0.5, 0.5}), 0.0);
  EXPECT_EQ(box.squaredDistance({2, 3, 0.5}), 5.0);
  EXPECT_EQ(box.squaredDistance({-2, -1, -2}), 9.0);
}

}  // namespace
}  // namespace soft_tissue
