#include "soft_tissue_sim/field/grid_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "soft_tissue_sim/base/error.h"
#include "support/field_meshes.h"
#include "support/field_oracle.h"

namespace soft_tissue
{
namespace
{
using test::FieldBody;

struct Errors
{
  double mean = 0.0, largest = 0.0;
};

/** Of inner nodes' depths read from a grid, against the nearest of all triangles. */
template <typename Read>
Errors nodeErrors(const FieldBody& body, const Read& read)
{
  const Points& x = body.mesh.nodes;
  Errors errors;
  int count = 0;
  for (std::size_t node = 0; node < x.size(); ++node)
  {
    if (body.surface.node_slot[node] < 0)
    {
      const double exact = test::bruteForceDistance(x[node], x, body.surface.triangles);
      const double error = std::abs(read(x[node]) - exact);
      EXPECT_TRUE(std::isfinite(error));
      errors.mean += error;
      errors.largest = std::max(errors.largest, error);
      ++count;
    }
  }
  errors.mean /= count;
  return errors;
}

TEST(GridField, ConvergesWithTheOrderAskedFor)
{
  const FieldBody ball(test::ballMesh(12, 1.0));
  const Points& x = ball.mesh.nodes;
  for (const GridOrder order : {GridOrder::first, GridOrder::second})
  {
    std::vector<Errors> all;
    std::vector<double> spacings;
    for (const int points : {20, 35, 60})
    {
      GridField field(GridSpec::around(boundsOf(x), {points, points, points}), order);
      field.march(ball.surface, x);
      const Errors errors = nodeErrors(ball, [&](const Vec3& p) { return field.extrapolate(p); });
      const Errors linear = nodeErrors(ball, [&](const Vec3& p) { return field.interpolate(p); });
      const double spacing = field.grid().spacing.x();
      std::cout << "order " << (order == GridOrder::second ? 2 : 1) << ", " << points
                << "^3: mean error " << errors.mean << ", largest " << errors.largest
                << "; read linearly " << linear.mean << ", " << linear.largest << "\n";
      all.push_back(errors);
      spacings.push_back(spacing);
    }
    const double observed =
        std::log(all.front().mean / all.back().mean) / std::log(spacings.front() / spacings.back());
    EXPECT_GT(observed, order == GridOrder::second ? 1.5 : 0.8);
    EXPECT_LT(all.back().mean, order == GridOrder::second ? 1e-3 : 1e-2);
  }
}

TEST(GridField, FindsTheCentreOfABallWithinOnePercent)
{
  const FieldBody ball(test::ballMesh(12, 1.0));
  const Points& x = ball.mesh.nodes;
  const double exact = test::bruteForceDistance(Vec3::Zero(), x, ball.surface.triangles);
  GridField field(GridSpec::around(boundsOf(x), {60, 60, 60}), GridOrder::second);
  field.march(ball.surface, x);
  EXPECT_NEAR(field.extrapolate(Vec3::Zero()), exact, 0.01 * exact);
}

TEST(GridField, IsExactWhereFrontsArePlane)
{
  const FieldBody slab(test::boxMesh({6, 6, 3}, {1.0, 1.0, 0.25}));
  const Points& x = slab.mesh.nodes;
  for (const GridOrder order : {GridOrder::first, GridOrder::second})
  {
    GridField field(GridSpec::around(boundsOf(x), {37, 29, 17}), order);
    field.march(slab.surface, x);
    for (Index point = 0; point < field.grid().size(); ++point)
    {
      const Vec3 p = field.grid().point(point);
      const double to_walls =
          std::min(p.head<2>().minCoeff(), (1.0 - p.head<2>().array()).minCoeff());
      const double depth = std::min(p.z(), 0.25 - p.z());
      if (to_walls > 0.35 && depth >= 0.0)  // away from the ridges at the sides
      {
        EXPECT_NEAR(field.depth()[point], depth, 1e-13);
      }
    }
  }
}

TEST(GridField, TellsInsideFromOutsideAtEdgesAndCorners)
{
  // Three quarters of a block: corners that stick out and one edge that goes in.
  const FieldBody arm(test::lMesh(6));
  const Points& x = arm.mesh.nodes;
  GridField field(GridSpec::around(boundsOf(x), {31, 26, 23}), GridOrder::second);
  field.march(arm.surface, x);
  int inside_count = 0;
  for (Index point = 0; point < field.grid().size(); ++point)
  {
    const Vec3 p = field.grid().point(point);
    const bool in_box = (p.array() > 0.0).all() && p.x() < 1.0 && p.y() < 1.0 && p.z() < 0.5;
    const bool inside = in_box && (p.x() < 0.5 || p.y() < 0.5);
    const double exact = test::bruteForceDistance(p, x, arm.surface.triangles);
    const double depth = field.depth()[point];
    if (exact < 1e-9)
    {
      continue;
    }
    if (inside)
    {
      ++inside_count;
      EXPECT_NEAR(depth, exact, 0.02);
    }
    else
    {
      EXPECT_TRUE(std::isnan(depth) || depth < 0.0);
      EXPECT_TRUE(std::isnan(depth) || std::abs(depth + exact) < 0.2);
    }
  }
  EXPECT_GT(inside_count, 1000);
}

TEST(GridField, MarchesInThePlaneAsWell)
{
  // A ring: a square with a square hole, of two triangles a cell.
  Points x;
  std::vector<Triangle> triangles;
  constexpr int kNodes = 13;
  for (int j = 0; j < kNodes; ++j)
  {
    for (int i = 0; i < kNodes; ++i)
    {
      x.emplace_back(i / 12.0, j / 12.0, 0.0);
      const bool hole = i >= 4 && i < 8 && j >= 4 && j < 8;
      if (i + 1 < kNodes && j + 1 < kNodes && !hole)
      {
        const Index a = j * kNodes + i;
        triangles.push_back({a, a + 1, a + kNodes + 1});
        triangles.push_back({a, a + kNodes + 1, a + kNodes});
      }
    }
  }
  const BoundarySurface boundary = extractPlanarBoundary(static_cast<Index>(x.size()), triangles);
  EXPECT_EQ(boundary.triangles.size(), 48u + 16u);
  GridField field(GridSpec::around(boundsOf(x), {65, 65, 1}), GridOrder::second);
  field.march(boundary, x);
  for (Index point = 0; point < field.grid().size(); ++point)
  {
    const Vec3 p = field.grid().point(point);
    const double exact = test::bruteForceDistance(p, x, boundary.triangles);
    const bool in_hole = (p.head<2>().array() - 0.5).abs().maxCoeff() < 1.0 / 6.0;
    const bool in_square = (p.head<2>().array() - 0.5).abs().maxCoeff() < 0.5;
    if (in_square && !in_hole && exact > 1e-9)
    {
      EXPECT_NEAR(field.depth()[point], exact, 0.006);
    }
    else if (exact > 1e-9)
    {
      EXPECT_FALSE(field.depth()[point] > 0.0);
    }
  }
  EXPECT_TRUE(std::isnan(field.interpolate(Vec3(0.5, 0.5, 0.0)))) << "in the hole";
  EXPECT_TRUE(std::isnan(field.interpolate(Vec3(5.0, 0.5, 0.0)))) << "beside the grid";
  EXPECT_TRUE(std::isnan(field.extrapolate(Vec3(5.0, 0.5, 0.0))));
  EXPECT_NEAR(field.interpolate(Vec3(1.0 / 6.0, 0.5, 0.0)), 1.0 / 6.0, 0.01);
}

TEST(GridField, RepeatsItselfBitForBit)
{
  const FieldBody ball(test::ballMesh(8, 1.0)), other(test::ballMesh(6, 0.7));
  GridField used(GridSpec::around(boundsOf(ball.mesh.nodes), {24, 20, 22}), GridOrder::second);
  used.march(other.surface, other.mesh.nodes);
  used.march(ball.surface, ball.mesh.nodes);
  GridField fresh(used.grid(), GridOrder::second);
  fresh.march(ball.surface, ball.mesh.nodes);
  for (std::size_t point = 0; point < fresh.depth().size(); ++point)
  {
    const bool both_none = std::isnan(used.depth()[point]) && std::isnan(fresh.depth()[point]);
    EXPECT_TRUE(both_none || used.depth()[point] == fresh.depth()[point]);
  }
}

/** Largest difference of the depths inside of two fields on one grid, m. */
double difference(const GridField& a, const GridField& b)
{
  double largest = 0.0;
  for (std::size_t point = 0; point < a.depth().size(); ++point)
  {
    const double da = a.depth()[point], db = b.depth()[point];
    EXPECT_EQ(da > 0.0, db > 0.0) << "inside is inside";
    if (da > 0.0)
    {
      largest = std::max(largest, std::abs(da - db));
    }
  }
  return largest;
}

/** A ball with a grid around it, marched at rest. */
struct GriddedBall
{
  FieldBody body{test::ballMesh(14, 1.0)};
  GridSpec grid = GridSpec::around(boundsOf(body.mesh.nodes), {40, 40, 40});
  double cell = grid.spacing.x();

  GridField marched(const Points& x) const
  {
    GridField field(grid, GridOrder::second);
    field.march(body.surface, x);
    return field;
  }

  /** Pressed in by this depth about the end of the x axis, over half a radius. */
  Points dented(double depth) const
  {
    Points x = body.mesh.nodes;
    for (Vec3& p : x)
    {
      const double away = (p - Vec3::UnitX()).norm() / 0.5;
      p.x() -= away < 1.0 ? depth * (1.0 - away * away) * (1.0 - away * away) : 0.0;
    }
    return x;
  }
};

constexpr double kOutside = 2.0;

Box3 boxFrom(double x)
{
  Box3 box;
  box.extend(Vec3(x, -0.8, -0.8));
  box.extend(Vec3(kOutside, 0.8, 0.8));
  return box;
}

TEST(GridUpdate, OfWhatDidNotMoveChangesNothing)
{
  const GriddedBall ball;
  const Points& x = ball.body.mesh.nodes;
  const GridField before = ball.marched(x);
  GridField field = ball.marched(x);
  const GridUpdate report = field.update({boxFrom(0.2)}, ball.body.surface, x);
  EXPECT_FALSE(report.whole);
  EXPECT_GT(report.points, 1000);
  EXPECT_LT(report.largest_jump, 0.1 * ball.cell);
  EXPECT_LT(difference(field, before), 0.1 * ball.cell);
}

TEST(GridUpdate, OfTheFirstOrderChangesOnlyRoundingWhereNothingMoved)
{
  const FieldBody arm(test::lMesh(12));  // not convex
  const Points& x = arm.mesh.nodes;
  GridField field(GridSpec::around(boundsOf(x), {31, 37, 20}), GridOrder::first);
  field.march(arm.surface, x);
  const std::vector<double> before = field.depth();
  Box3 box;
  box.extend(Vec3::Constant(-1.0));
  box.extend(0.5 * (boundsOf(x).min + boundsOf(x).max));
  const GridUpdate report = field.update({box}, arm.surface, x);
  EXPECT_LT(report.largest_jump, 1e-12);
  EXPECT_FALSE(report.blended || report.whole);
  for (std::size_t i = 0; i < before.size(); ++i)
  {
    EXPECT_FALSE(std::abs(field.depth()[i] - before[i]) > 1e-12);
    EXPECT_EQ(std::isnan(field.depth()[i]), std::isnan(before[i]));
  }
}

TEST(GridUpdate, OfADentAgreesWithAMarchOfEverything)
{
  const GriddedBall ball;
  GridField field = ball.marched(ball.body.mesh.nodes);
  for (const double depth : {0.01, 0.02, 0.03})
  {
    const Points x = ball.dented(depth);
    const std::uint64_t before = field.evaluations();
    // Two boxes that overlap, and one that holds no point of the grid.
    Box3 upper = boxFrom(0.05), lower = boxFrom(0.05), beside;
    upper.min.z() = -0.2;
    lower.max.z() = 0.2;
    beside.extend(Vec3::Constant(7.0));
    const GridUpdate report = field.update({upper, lower, beside}, ball.body.surface, x);
    const std::uint64_t update_evaluations = field.evaluations() - before;
    const GridField all = ball.marched(x);
    EXPECT_FALSE(report.whole) << depth;
    EXPECT_LT(update_evaluations, all.evaluations() / 2);
    EXPECT_LT(difference(field, all), 0.5 * ball.cell) << depth;
  }
}

TEST(GridUpdate, ThatDoesNotFitMarchesEverything)
{
  const GriddedBall ball;
  Points pressed = ball.body.mesh.nodes;
  for (Vec3& p : pressed)
  {
    p.z() *= 0.6;
  }
  GridField field = ball.marched(ball.body.mesh.nodes);
  const GridUpdate report = field.update({boxFrom(0.3)}, ball.body.surface, pressed);
  EXPECT_TRUE(report.whole);
  EXPECT_GT(report.largest_jump, 0.25 * ball.cell);
  EXPECT_EQ(difference(field, ball.marched(pressed)), 0.0);
}

TEST(GridField, RefusesGridsWithoutExtent)
{
  GridSpec grid;
  grid.count = {10, 1, 10};
  EXPECT_THROW(GridField(grid, GridOrder::first), Error);
  grid.count = {10, 10, 10};
  grid.spacing.y() = 0.0;
  EXPECT_THROW(GridField(grid, GridOrder::first), Error);
  grid.spacing.y() = std::nan("");
  EXPECT_THROW(GridField(grid, GridOrder::first), Error);
  grid.spacing.y() = 1.0;
  grid.count = {5000, 5000, 5000};
  EXPECT_THROW(GridField(grid, GridOrder::first), Error);
}

}  // namespace
}  // namespace soft_tissue
