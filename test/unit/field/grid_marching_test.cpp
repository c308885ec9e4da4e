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

constexpr int kPoints = 60;

std::unique_ptr<DistanceField> gridField(const FieldBody& body, int points = kPoints)
{
  FieldOptions options;
  options.grid_points = points;
  return makeDistanceField("grid", body.topology(), options);
}

/** Largest error at a node, in cells; everything finite, and nothing below zero. */
double errorInCells(const std::string& name, const FieldBody& body, DistanceField& field,
                    const Points& x)
{
  field.march(x);
  const std::vector<double> exact = test::exactDepths(body, x);
  Vec3 low = x[0], high = x[0];
  double largest = 0.0;
  for (std::size_t node = 0; node < x.size(); ++node)
  {
    low = low.cwiseMin(x[node]);
    high = high.cwiseMax(x[node]);
    EXPECT_GE(field.depth()[node], 0.0) << name;
    EXPECT_EQ(field.closestTriangle()[node] >= 0, body.surface.node_slot[node] >= 0) << name;
    largest = std::max(largest, std::abs(field.depth()[node] - exact[node]));
  }
  const double cells = largest / ((high - low).maxCoeff() / (kPoints - 5));
  std::cout << name << ": largest error " << cells << " cells\n";
  return cells;
}

TEST(GridMarching, GivesNodesTheirDepthWithinACell)
{
  const FieldBody ball(test::ballMesh(12, 0.05));
  EXPECT_LT(errorInCells("ball", ball, *gridField(ball), ball.mesh.nodes), 0.3);
  const FieldBody arm(test::lMesh(12));
  EXPECT_LT(errorInCells("L", arm, *gridField(arm), arm.mesh.nodes), 1.0)
      << "the reflex edge is a source of circles that a grid does not resolve";
  const FieldBody two(test::twoBalls());
  EXPECT_LT(errorInCells("two balls", two, *gridField(two), two.mesh.nodes), 0.5);
}

TEST(GridMarching, FollowsABodyThatMovesAndStretches)
{
  const FieldBody ball(test::ballMesh(10, 0.05));
  const auto field = gridField(ball);
  field->march(ball.mesh.nodes);
  Points x = ball.mesh.nodes;
  for (Vec3& p : x)
  {
    p = Vec3(0.7 * p.x() + 3.0, 1.2 * p.y(), 1.2 * p.z() - 1.0);
  }
  EXPECT_LT(errorInCells("squashed ball", ball, *field, x), 0.3);
}

TEST(GridMarching, UntilSomeNodesReadsTheseAlone)
{
  const FieldBody ball(test::ballMesh(8, 0.05));
  const auto full = gridField(ball), lazy = gridField(ball);
  full->march(ball.mesh.nodes);
  Index inner = 0;
  while (ball.surface.node_slot[inner] >= 0)
  {
    ++inner;
  }
  lazy->marchUntil(ball.mesh.nodes, {inner, ball.surface.nodes[0]});
  int known = 0;
  for (Index node = 0; node < static_cast<Index>(ball.mesh.nodes.size()); ++node)
  {
    known += ball.surface.node_slot[node] < 0 && !std::isnan(lazy->depth()[node]) ? 1 : 0;
  }
  EXPECT_EQ(known, 1);
  EXPECT_EQ(lazy->depth()[inner], full->depth()[inner]);
  const std::uint64_t before = lazy->evaluations();
  lazy->marchUntil(ball.mesh.nodes, {ball.surface.nodes[0]});
  EXPECT_EQ(lazy->evaluations(), before) << "boundary nodes need no grid";
  EXPECT_TRUE(std::isnan(lazy->depth()[inner]));
}

TEST(GridMarching, GivesTheTrueDepthWhereItsGridHasNone)
{
  const FieldBody ball(test::ballMesh(8, 0.05));
  Points inside_out = ball.mesh.nodes;
  for (Vec3& p : inside_out)
  {
    p.x() = -p.x();
  }
  const auto field = gridField(ball);
  field->march(inside_out);
  const std::vector<double> exact = test::exactDepths(ball, inside_out);
  for (std::size_t node = 0; node < exact.size(); ++node)
  {
    EXPECT_EQ(field->depth()[node], ball.surface.node_slot[node] >= 0 ? 0.0 : exact[node]);
  }
}

TEST(GridMarching, RefusesTooFewPoints)
{
  const FieldBody ball(test::ballMesh(4, 0.05));
  EXPECT_THROW(gridField(ball, 7), Error);
}

}  // namespace
}  // namespace soft_tissue
