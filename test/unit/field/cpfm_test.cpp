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

/** The oracle: the nearest of all boundary nodes, one after the other. */
double nearestBoundaryNode(const FieldBody& body, const Vec3& p)
{
  double least = std::numeric_limits<double>::infinity();
  for (const Index node : body.surface.nodes)
  {
    least = std::min(least, (p - body.mesh.nodes[node]).norm());
  }
  return least;
}

/** Share of inner nodes that are not told of their nearest boundary node. */
double wrongShare(const FieldBody& body)
{
  const Points& x = body.mesh.nodes;
  const auto field = body.field("cpfm");
  field->march(x);
  double wrong = 0.0, inner = 0.0;
  for (std::size_t node = 0; node < x.size(); ++node)
  {
    const double depth = field->depth()[node];
    if (body.surface.node_slot[node] >= 0)
    {
      EXPECT_EQ(depth, 0.0);
      continue;
    }
    const double exact = nearestBoundaryNode(body, x[node]);
    EXPECT_GE(depth, exact * (1.0 - 1e-15));
    const Triangle& t = body.surface.triangles[field->closestTriangle()[node]];
    const bool at_corner = std::any_of(
        t.begin(), t.end(), [&](Index corner) { return (x[node] - x[corner]).norm() == depth; });
    EXPECT_TRUE(at_corner) << "the triangle is one on the node found";
    inner += 1.0;
    wrong += depth > exact * (1.0 + 1e-12) ? 1.0 : 0.0;
  }
  return wrong / inner;
}

TEST(Cpfm, IsTheDistanceToABoundaryNodeMostlyTheNearest)
{
  EXPECT_LT(wrongShare(FieldBody(test::boxMesh({10, 10, 10}, {1, 1, 1}))), 0.001);
  EXPECT_LT(wrongShare(FieldBody(test::boxMesh({12, 9, 7}, {0.4, 0.1, 0.1}))), 0.05);
  EXPECT_LT(wrongShare(FieldBody(test::ballMesh(12, 1.0))), 0.8);
}

TEST(Cpfm, LazyMarchesAgreeWithTheFullOne)
{
  const FieldBody body(test::ballMesh(10, 1.0));
  const auto full = body.field("cpfm"), lazy = body.field("cpfm");
  full->march(body.mesh.nodes);
  const std::vector<Index> wanted = {5, 300, 700, 900};
  lazy->marchUntil(body.mesh.nodes, wanted);
  for (const Index node : wanted)
  {
    EXPECT_EQ(lazy->depth()[node], full->depth()[node]);
  }
  EXPECT_LT(lazy->evaluations(), full->evaluations());
}

}  // namespace
}  // namespace soft_tissue
