#include "soft_tissue_sim/field/deformed_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/field_meshes.h"
#include "support/field_oracle.h"

namespace soft_tissue
{
namespace
{
using test::FieldBody;
using test::RandomGeometry;

TEST(DeformedDistance, IsExactInsideAndOutsideAtReflexEdgesToo)
{
  const FieldBody arm(test::lMesh(6));
  const Points& x = arm.mesh.nodes;
  DeformedDistance distance(arm.surface);
  EXPECT_TRUE(std::isnan(distance.at(Vec3::Zero()).depth)) << "before the first update";
  distance.update(x);
  RandomGeometry random(1);
  int inside_count = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const Vec3 p = Vec3(0.5, 0.5, 0.25) + random.point(0.7);
    const bool in_box = (p.array() > 0.0).all() && p.x() < 1.0 && p.y() < 1.0 && p.z() < 0.5;
    const bool inside = in_box && (p.x() < 0.5 || p.y() < 0.5);
    const double exact = test::bruteForceDistance(p, x, arm.surface.triangles);
    const DeformedDistance::Answer answer = distance.at(p);
    EXPECT_EQ(answer.depth, inside ? exact : -exact);
    inside_count += inside ? 1 : 0;
    // Where depth goes along the gradient, over a millionth of the body.
    const double step = 1e-6;
    EXPECT_NEAR(distance.at(p + step * answer.gradient).depth, answer.depth + step, 1e-9);
  }
  EXPECT_GT(inside_count, 100);
}

TEST(DeformedDistance, FollowsTheBodyAndKnowsItsSurface)
{
  const FieldBody ball(test::ballMesh(8, 1.0));
  DeformedDistance distance(ball.surface);
  RandomGeometry random(2);
  Points x = ball.mesh.nodes;
  distance.update(x);
  for (Vec3& p : x)
  {
    p = Vec3(1.5 * p.x(), 0.6 * p.y(), p.z()) + Vec3(3, 0, 0);
  }
  distance.update(x);
  for (int i = 0; i < 200; ++i)
  {
    const Vec3 p = Vec3(3, 0, 0) + random.point(1.6);
    EXPECT_EQ(std::abs(distance.at(p).depth),
              test::bruteForceDistance(p, x, ball.surface.triangles));
  }
  EXPECT_GT(distance.at(Vec3(3, 0, 0)).depth, 0.4);
  EXPECT_LT(distance.at(Vec3(0, 0, 0)).depth, -1.0);
  const Index top = ball.surface.nodes.front();
  const DeformedDistance::Answer on_surface = distance.at(x[top]);
  EXPECT_NEAR(on_surface.depth, 0.0, 1e-15);
  EXPECT_NEAR(on_surface.gradient.norm(), 1.0, 1e-12);
  const DeformedDistance::Answer nowhere = distance.at(Vec3(NAN, 0, 0));
  EXPECT_TRUE(std::isnan(nowhere.depth));
  EXPECT_EQ(nowhere.gradient, Vec3(Vec3::Zero()));
  EXPECT_EQ(nowhere.triangle, -1);
}

TEST(DeformedDistance, TellsOfPointsWhoseSquaresOverflow)
{
  const FieldBody ball(test::ballMesh(4, 1.0));
  DeformedDistance distance(ball.surface);
  distance.update(ball.mesh.nodes);
  for (const double far : {1e99, 1e101, 1e200, 1e308})
  {
    const DeformedDistance::Answer answer = distance.at(Vec3(0.6 * far, 0, -0.8 * far));
    EXPECT_NEAR(answer.depth / far, -1.0, 1e-12) << far;
    EXPECT_NEAR((answer.gradient - Vec3(-0.6, 0, 0.8)).norm(), 0.0, 1e-12) << far;
  }
  const double largest = std::numeric_limits<double>::max();
  EXPECT_EQ(distance.at(Vec3(largest, largest, 0)).depth, -std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace soft_tissue
