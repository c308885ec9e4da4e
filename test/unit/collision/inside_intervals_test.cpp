#include "soft_tissue_sim/collision/inside_intervals.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
namespace
{
std::vector<Interval> insideOf(const RigidShape& shape, const Vec3& a, const Vec3& b, int cells)
{
  std::vector<Interval> all;
  const auto distance = [&](double t) {
    const SignedDistance at = shape.distance(a + t * (b - a));
    return SegmentDistance{at.distance, at.normal.dot(b - a)};
  };
  forEachInsideInterval(distance, (b - a).norm(), cells,
                        [&](const InsideInterval& inside) { all.push_back(inside.where); });
  return all;
}

double lengthOf(const std::vector<Interval>& intervals)
{
  double sum = 0.0;
  for (const Interval& i : intervals)
  {
    sum += i.end - i.begin;
  }
  return sum;
}
}  // namespace

TEST(InsideIntervals, AddUpToTheChordOfASphere)
{
  const auto sphere = makeSphere(1.0);
  for (const double height : {0.0, 0.5, 0.9, 0.999, 0.999999})
  {
    for (const int cells : {1, 2, 7})
    {
      const double half_chord = std::sqrt(1.0 - height * height);
      const auto inside = insideOf(*sphere, {-1.4, height, 0}, {1.7, height, 0}, cells);
      EXPECT_NEAR(lengthOf(inside) * 3.1, 2.0 * half_chord, 1e-9) << height << " " << cells;
      ASSERT_FALSE(inside.empty());
      EXPECT_NEAR(inside.front().begin * 3.1, 1.4 - half_chord, 1e-9);
    }
  }
}

TEST(InsideIntervals, KeepTheCellsWhollyInside)
{
  const auto inside = insideOf(*makeBox({2, 2, 2}), {-2, 0.1, 0.2}, {2, 0.1, 0.2}, 8);
  ASSERT_EQ(inside.size(), 4u);  // ends of the box are ends of cells
  EXPECT_NEAR(inside[0].begin, 0.25, 1e-9);
  EXPECT_EQ(inside[1].begin, 0.375);
  EXPECT_EQ(inside[2].end, 0.625);
  EXPECT_NEAR(inside[3].end, 0.75, 1e-9);
}

TEST(InsideIntervals, AreNoneForASegmentThatMisses)
{
  EXPECT_TRUE(insideOf(*makeSphere(1.0), {-2, 1.0001, 0}, {2, 1.0001, 0}, 3).empty());
  EXPECT_TRUE(insideOf(*makeSphere(1.0), {5, 0, 0}, {6, 0, 0}, 3).empty());
}

TEST(InsideIntervals, MatchDenseSamplingOfRandomSegments)
{
  RandomGeometry random(5);
  const auto capsule = makeCapsule(0.3, 0.8);
  for (int i = 0; i < 200; ++i)
  {
    const Vec3 a = random.point(1.0);
    const Vec3 b = random.point(1.0);
    int hits = 0;
    constexpr int kSamples = 2000;
    for (int k = 0; k < kSamples; ++k)
    {
      hits += capsule->distance(a + (k + 0.5) / kSamples * (b - a)).distance < 0.0 ? 1 : 0;
    }
    EXPECT_NEAR(lengthOf(insideOf(*capsule, a, b, 4)), double(hits) / kSamples, 2.0 / kSamples);
  }
}

}  // namespace soft_tissue::test
