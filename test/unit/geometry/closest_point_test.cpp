#include "soft_tissue_sim/geometry/closest_point.h"

#include <gtest/gtest.h>

#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

/** What holds for any nearest point of any triangle: it lies on it and is what it says. */
void expectConsistent(const TrianglePoint& found, const Vec3& p, const Vec3& a, const Vec3& b,
                      const Vec3& c)
{
  const double scale = std::max({a.norm(), b.norm(), c.norm(), p.norm()});
  EXPECT_TRUE(found.weights.allFinite());
  EXPECT_GE(found.weights.minCoeff(), 0.0);
  EXPECT_NEAR(found.weights.sum(), 1.0, 1e-15);
  const Vec3 from_weights = found.weights[0] * a + found.weights[1] * b + found.weights[2] * c;
  EXPECT_LE((from_weights - found.point).norm(), 1e-15 * scale * 4);
  EXPECT_DOUBLE_EQ(found.squared_distance, (p - found.point).squaredNorm());
}

/** No corner may be nearer in the half space beyond the nearest point: its optimality. */
void expectOptimal(const TrianglePoint& found, const Vec3& p, const Vec3& a, const Vec3& b,
                   const Vec3& c)
{
  const Vec3 towards = p - found.point;
  for (const Vec3& corner : {a, b, c})
  {
    const Vec3 along = corner - found.point;
    EXPECT_LE(towards.dot(along), 1e-12 * (1e-3 + towards.norm() * (towards.norm() + along.norm())))
        << "p " << p.transpose();
  }
}

TEST(ClosestOnSegment, MatchesSamplesAndEnds)
{
  RandomGeometry random(1);
  for (int trial = 0; trial < 300; ++trial)
  {
    const Vec3 a = random.point(1.0);
    const Vec3 b = random.point(1.0);
    const Vec3 p = random.point(2.0);
    const SegmentPoint found = closestOnSegment(p, a, b);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= 1000; ++i)
    {
      least = std::min(least, (p - a - i / 1000.0 * (b - a)).norm());
    }
    EXPECT_LE(std::sqrt(found.squared_distance), least + 1e-15);
    EXPECT_GE(std::sqrt(found.squared_distance), least - 1e-3 * (b - a).norm());
    EXPECT_LE((a + found.parameter * (b - a) - found.point).norm(), 1e-15);
  }
}

TEST(ClosestOnSegment, TreatsZeroLengthAsAPoint)
{
  const Vec3 a(0.1, 0.2, 0.3);
  const SegmentPoint found = closestOnSegment(Vec3(1, 2, 3), a, a);
  EXPECT_EQ(found.point, a);
  EXPECT_EQ(found.parameter, 0.0);
  EXPECT_DOUBLE_EQ(found.squared_distance, (Vec3(1, 2, 3) - a).squaredNorm());
}

TEST(ClosestOnTriangle, MatchesSamplesInAnyPoseAndUnit)
{
  RandomGeometry random(2);
  for (int trial = 0; trial < 400; ++trial)
  {
    const double unit = trial % 2 == 0 ? 1.0 : 1e-3;
    const Vec3 a = unit * random.point(1.0);
    const Vec3 b = unit * random.point(1.0);
    const Vec3 c = unit * random.point(1.0);
    const Vec3 p = unit * random.point(2.0);
    const TrianglePoint found = closestOnTriangle(p, a, b, c);
    expectConsistent(found, p, a, b, c);
    const double sampled = test::sampledTriangleDistance(p, a, b, c, 60);
    const double cell = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()}) / 60;
    EXPECT_LE(std::sqrt(found.squared_distance), sampled * (1 + 1e-14));
    EXPECT_GE(std::sqrt(found.squared_distance), sampled - cell);
  }
}

TEST(ClosestOnTriangle, IsOptimalForNearAndFarPoints)
{
  RandomGeometry random(3);
  for (int trial = 0; trial < 3000; ++trial)
  {
    const Vec3 a = random.point(1.0);
    const Vec3 b = random.point(1.0);
    const Vec3 c = random.point(1.0);
    const double reach = trial % 3 == 0 ? 0.5 : (trial % 3 == 1 ? 2.0 : 50.0);
    const Vec3 p = random.point(reach);
    expectOptimal(closestOnTriangle(p, a, b, c), p, a, b, c);
  }
}

TEST(ClosestOnTriangle, FindsEachFeature)
{
  const Vec3 a(0, 0, 0);
  const Vec3 b(1, 0, 0);
  const Vec3 c(0, 1, 0);
  EXPECT_EQ(closestOnTriangle({-1, -1, 1}, a, b, c).weights, Vec3(1, 0, 0));
  EXPECT_EQ(closestOnTriangle({2, -0.5, 1}, a, b, c).weights, Vec3(0, 1, 0));
  EXPECT_EQ(closestOnTriangle({-0.5, 2, 1}, a, b, c).weights, Vec3(0, 0, 1));
  EXPECT_EQ(closestOnTriangle({0.5, -1, 1}, a, b, c).weights, Vec3(0.5, 0.5, 0));
  EXPECT_EQ(closestOnTriangle({1, 1, 1}, a, b, c).weights, Vec3(0, 0.5, 0.5));
  EXPECT_EQ(closestOnTriangle({-1, 0.5, 1}, a, b, c).weights, Vec3(0.5, 0, 0.5));
  EXPECT_EQ(closestOnTriangle({0.25, 0.25, 1}, a, b, c).weights, Vec3(0.5, 0.25, 0.25));
}

TEST(ClosestOnTriangle, SurvivesNeedlesAndPoints)
{
  RandomGeometry random(4);
  for (int trial = 0; trial < 2000; ++trial)
  {
    const Vec3 a = random.point(1.0);
    const Vec3 along = random.direction();
    const double width = trial % 4 == 0 ? 0.0 : std::pow(10.0, -4.0 * (trial % 4) - 2.0);
    Vec3 b = a + along;
    Vec3 c = a + random.uniform(-0.5, 1.5) * along + width * random.direction();
    if (trial % 7 == 0)
    {
      b = a;
    }
    if (trial % 11 == 0)
    {
      c = b;
    }
    const Vec3 p = random.point(2.0);
    const TrianglePoint found = closestOnTriangle(p, a, b, c);
    expectConsistent(found, p, a, b, c);
    // It can't be farther than the nearest of the edges, nor nearer by more than the width.
    const double edges = std::sqrt(std::min({closestOnSegment(p, a, b).squared_distance,
                                             closestOnSegment(p, b, c).squared_distance,
                                             closestOnSegment(p, c, a).squared_distance}));
    EXPECT_LE(std::sqrt(found.squared_distance), edges);
    EXPECT_GE(std::sqrt(found.squared_distance), edges - width - 1e-15);
    expectOptimal(found, p, a, b, c);
  }
}

}  // namespace
}  // namespace soft_tissue
