#include <gtest/gtest.h>

#include <cmath>

#include "support/field_meshes.h"
#include "support/field_oracle.h"

namespace soft_tissue
{
namespace
{
using test::FieldBody;

/** What every method promises however bad a body is: numbers, none below zero, zero on the
 * boundary.
 */
class DegenerateBodies : public testing::TestWithParam<const char*>
{
 protected:
  void expectDepths(const std::string& name, const FieldBody& body, const Points& x)
  {
    const auto field = body.field(GetParam());
    field->march(x);
    const std::vector<double> exact = test::exactDepths(body, x);
    const bool is_exact = std::string(GetParam()) == "exact_marching";
    for (std::size_t node = 0; node < x.size(); ++node)
    {
      if (!x[node].allFinite() || body.neighbours.begin(static_cast<Index>(node)) ==
                                      body.neighbours.end(static_cast<Index>(node)))
      {
        continue;
      }
      const double depth = field->depth()[node];
      EXPECT_TRUE(std::isfinite(depth)) << name << ", node " << node;
      EXPECT_GE(depth, 0.0) << name;
      if (body.surface.node_slot[node] >= 0)
      {
        EXPECT_EQ(depth, 0.0) << name;
      }
      else if (is_exact)
      {
        EXPECT_EQ(depth, exact[node]) << name;
      }
    }
  }
  void expectDepths(const std::string& name, const FieldBody& body)
  {
    expectDepths(name, body, body.mesh.nodes);
  }
};

TEST_P(DegenerateBodies, BoundariesThatAreNotManifolds)
{
  TetMesh edge;  // two tets with an edge in common, then two with a node
  edge.nodes = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  edge.tets = {{0, 2, 3, 1}, {0, 4, 5, 1}};
  expectDepths("an edge in common", FieldBody(edge));
  TetMesh node;
  node.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  node.tets = {{0, 1, 2, 3}, {0, 5, 4, 6}};
  expectDepths("a node in common", FieldBody(node));
  // Two boxes whose corners are one node.
  TetMesh first = test::boxMesh({4, 4, 4}, {1, 1, 1});
  const TetMesh second = first;
  const auto corner = static_cast<Index>(first.nodes.size()) - 1;
  const auto offset = static_cast<Index>(first.nodes.size()) - 1;
  ASSERT_EQ(first.nodes[corner], Vec3(1, 1, 1));
  ASSERT_EQ(second.nodes[0], Vec3(0, 0, 0));
  for (std::size_t i = 1; i < second.nodes.size(); ++i)
  {
    first.nodes.push_back(second.nodes[i] + Vec3(1, 1, 1));
  }
  for (const Tet& tet : second.tets)
  {
    Tet moved;
    for (int k = 0; k < 4; ++k)
    {
      moved[k] = tet[k] == 0 ? corner : tet[k] + offset;
    }
    first.tets.push_back(moved);
  }
  expectDepths("boxes at a corner", FieldBody(first));
}

TEST_P(DegenerateBodies, BoundariesThatAreOpen)
{
  FieldBody body(test::ballMesh(8, 0.05));
  // As if a file had lost a sixth of its boundary faces: their nodes still count as boundary.
  std::vector<Triangle>& triangles = body.surface.triangles;
  triangles.resize(triangles.size() - triangles.size() / 6);
  for (Index slot = 0; slot < static_cast<Index>(body.surface.nodes.size()); ++slot)
  {
    ASSERT_GE(body.surface.node_slot[body.surface.nodes[slot]], 0);
  }
  expectDepths("open", body);
}

TEST_P(DegenerateBodies, FlatFoldedTurnedOverAndLost)
{
  const FieldBody body(test::ballMesh(6, 0.05));
  const auto mapped = [&](const auto& map) {
    Points x;
    for (const Vec3& p : body.mesh.nodes)
    {
      x.push_back(map(p));
    }
    return x;
  };
  expectDepths("flat", body, mapped([](const Vec3& p) { return Vec3(p.x(), p.y(), 0.0); }));
  expectDepths("slivers", body,
               mapped([](const Vec3& p) { return Vec3(p.x(), p.y(), 1e-9 * p.z()); }));
  expectDepths("a line", body, mapped([](const Vec3& p) { return Vec3(p.x(), 0.0, 0.0); }));
  expectDepths("a point", body, mapped([](const Vec3&) { return Vec3(1, 2, 3); }));
  expectDepths("inside out", body,
               mapped([](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); }));
  expectDepths("folded", body,
               mapped([](const Vec3& p) { return Vec3(std::abs(p.x() - 0.01), p.y(), p.z()); }));
  test::RandomGeometry random(3);
  expectDepths("shaken", body, mapped([&](const Vec3& p) { return Vec3(p + random.point(0.05)); }));
  Points lost = body.mesh.nodes;
  lost[0] = Vec3::Constant(NAN);
  lost[1].x() = INFINITY;
  lost[2].y() = 1e300;
  const auto field = body.field(GetParam());
  field->march(body.mesh.nodes);
  field->march(lost);
  for (const double depth : field->depth())
  {
    EXPECT_FALSE(depth < 0.0 || std::isinf(depth)) << "a depth, or none";
  }
  expectDepths("all boundary", FieldBody(test::boxMesh({5, 4, 1}, {1, 1, 1})));
}

INSTANTIATE_TEST_SUITE_P(Methods, DegenerateBodies,
                         testing::Values("cpfm", "cffm", "exact_marching", "grid"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace soft_tissue
