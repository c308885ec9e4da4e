#include "soft_tissue_sim/geometry/halving_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace soft_tissue
{
namespace
{
/** In a box of 4 x 2 x 1. */
Points somePoints(std::size_t count)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Points points(count);
  for (Vec3& p : points)
  {
    p = Vec3(4.0 * uniform(random), 2.0 * uniform(random), uniform(random));
  }
  return points;
}
}  // namespace

TEST(HalvingOrder, HasEveryPointOnceAndOneSideFirst)
{
  const Points points = somePoints(1001);
  const std::vector<Index> order = halvingOrder(points);
  std::vector<Index> sorted = order, all(points.size());
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
  const auto left = [&](Index i, Index j) { return points[i].x() < points[j].x(); };
  const auto middle = order.begin() + 500;
  EXPECT_LT(points[*std::max_element(order.begin(), middle, left)].x(),
            points[*std::min_element(middle, order.end(), left)].x());
}

TEST(HalvingOrder, PartsAreItsStretches)
{
  const Points points = somePoints(1000);
  const std::vector<Index> order = halvingOrder(points);
  const std::vector<int> parts = halvedParts(points, 3);
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    EXPECT_EQ(parts[order[k]], static_cast<int>(k / 125));
  }
}

TEST(HalvingOrder, TakesPointsThatAreOneOrNone)
{
  EXPECT_TRUE(halvingOrder({}).empty());
  EXPECT_TRUE(halvedParts({}, 3).empty());
  const Points equal(50, Vec3(1.0, 2.0, 3.0));
  std::vector<Index> all(equal.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(halvingOrder(equal), all);
  EXPECT_EQ(halvedParts({Vec3::Zero()}, 3), std::vector<int>{0});
}

}  // namespace soft_tissue
