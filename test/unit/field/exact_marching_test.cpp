#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/base/parallel.h"
#include "support/field_meshes.h"
#include "support/field_oracle.h"

namespace soft_tissue
{
namespace
{
using test::FieldBody;
using test::RandomGeometry;

/** Every node's depth is the oracle's to the bit, in a full march and in lazy ones. */
void expectExact(DistanceField& field, const FieldBody& body, const Points& x)
{
  const std::vector<double> exact = test::exactDepths(body, x);
  const auto expectExactAt = [&](std::size_t node) {
    ASSERT_GE(field.closestTriangle()[node], 0);
    EXPECT_EQ(field.depth()[node], body.surface.node_slot[node] >= 0 ? 0.0 : exact[node]);
    const Triangle& t = body.surface.triangles[field.closestTriangle()[node]];
    if (body.surface.node_slot[node] < 0)
    {
      EXPECT_EQ(field.depth()[node], test::bruteForceDistance(x[node], x, {t}));
    }
  };
  field.march(x);
  for (std::size_t node = 0; node < x.size(); ++node)
  {
    expectExactAt(node);
  }
  RandomGeometry random(7);
  std::vector<Index> wanted;
  for (int i = 0; i < 20; ++i)
  {
    wanted.push_back(static_cast<Index>(random.uniform(0, static_cast<double>(x.size()))));
  }
  field.marchUntil(x, wanted);
  for (const Index node : wanted)
  {
    expectExactAt(node);
  }
  for (std::size_t node = 0; node < x.size(); ++node)
  {
    const bool known = body.surface.node_slot[node] >= 0 ||
                       std::count(wanted.begin(), wanted.end(), static_cast<Index>(node)) > 0;
    EXPECT_EQ(std::isnan(field.depth()[node]), !known) << "a lazy march looks at nothing else";
  }
}

void expectExact(const FieldBody& body, const Points& x)
{
  expectExact(*body.field("exact_marching"), body, x);
}

Points mapped(const Points& x, const std::function<Vec3(const Vec3&)>& map)
{
  Points result;
  for (const Vec3& p : x)
  {
    result.push_back(map(p));
  }
  return result;
}

TEST(ExactMarching, EqualsTheOracleOnAllShapes)
{
  for (const int cells : {4, 7, 12})
  {
    const FieldBody ball(test::ballMesh(cells, 0.05));
    expectExact(ball, ball.mesh.nodes);
  }
  const FieldBody slab(test::boxMesh({16, 16, 4}, {0.4, 0.4, 0.04}));
  expectExact(slab, slab.mesh.nodes);
  const FieldBody arm(test::lMesh(12));
  expectExact(arm, arm.mesh.nodes);
  const FieldBody thin(test::boxMesh({5, 4, 1}, {1, 1, 1}));
  expectExact(thin, thin.mesh.nodes);
  TetMesh tet;
  tet.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tet.tets = {{0, 1, 2, 3}};
  const FieldBody one(tet);
  expectExact(one, one.mesh.nodes);
}

TEST(ExactMarching, StaysExactHoweverABodyIsDeformed)
{
  const FieldBody body(test::boxMesh({24, 6, 6}, {0.4, 0.1, 0.1}));
  const Points& x = body.mesh.nodes;
  const auto field = body.field("exact_marching");  // its hints are those of other shapes
  expectExact(*field, body, x);
  expectExact(*field, body, mapped(x, [](const Vec3& p) {  // bent by 90 degrees
    const double angle = 0.5 * M_PI * p.x() / 0.4, radius = 0.4 / (0.5 * M_PI) - p.z();
    return Vec3(radius * std::sin(angle), p.y(), -radius * std::cos(angle));
  }));
  expectExact(*field, body, mapped(x, [](const Vec3& p) {  // twisted by 180 degrees
    const Eigen::AngleAxisd turn(M_PI * p.x() / 0.4, Vec3::UnitX());
    return Vec3(turn * (p - Vec3(0.0, 0.05, 0.05)));
  }));
  expectExact(*field, body,
              mapped(x, [](const Vec3& p) { return Vec3(p.x(), p.y(), 0.5 * p.z()); }));
  expectExact(*field, body, mapped(x, [](const Vec3& p) {  // folded through itself
    return Vec3(std::abs(p.x() - 0.15), p.y(), p.z());
  }));
  RandomGeometry random(1);
  expectExact(*field, body, mapped(x, [&](const Vec3& p) { return Vec3(p + random.point(0.1)); }));
  expectExact(*field, body, mapped(x, [](const Vec3& p) { return Vec3(p.x(), p.y(), 0.0); }));
  expectExact(*field, body, mapped(x, [](const Vec3& p) { return Vec3(p.x(), 0.0, 0.0); }));
  expectExact(*field, body, mapped(x, [](const Vec3&) { return Vec3(1, 2, 3); }));
  expectExact(*field, body, mapped(x, [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); }));
}

TEST(ExactMarching, HasTheSameBitsForAnyThreads)
{
  const FieldBody ball(test::ballMesh(18, 0.05));
  std::vector<std::vector<double>> depths;
  std::vector<std::vector<Index>> triangles;
  for (const int threads : {1, 2, 3})
  {
    setThreadCount(threads);
    const auto field = ball.field("exact_marching");
    for (int repeat = 0; repeat < 2; ++repeat)
    {
      field->march(ball.mesh.nodes);
      depths.push_back(field->depth());
      triangles.push_back(field->closestTriangle());
    }
  }
  setThreadCount(1);
  for (std::size_t i = 1; i < depths.size(); ++i)
  {
    EXPECT_EQ(depths[i], depths[0]);
    EXPECT_EQ(triangles[i], triangles[0]);
  }
}

TEST(ExactMarching, NeedsFewEvaluations)
{
  const FieldBody ball(test::ballMesh(20, 0.05));
  const auto field = ball.field("exact_marching");
  const auto count = [&] {
    const std::uint64_t before = field->evaluations();
    field->march(ball.mesh.nodes);
    return static_cast<double>(field->evaluations() - before) /
           static_cast<double>(ball.mesh.nodes.size());
  };
  EXPECT_LT(count(), 8.0);
  EXPECT_LT(count(), 2.0) << "the last march is the best hint";
}

TEST(ExactMarching, PartsLooseNodesAndNodesThatAreNoNumbers)
{
  TetMesh two = test::twoBalls();
  const FieldBody parts(two);
  expectExact(parts, parts.mesh.nodes);

  two.nodes.push_back(Vec3::Zero());
  const FieldBody loose(two);
  const auto field = loose.field("exact_marching");
  const Index alone = static_cast<Index>(two.nodes.size()) - 1;
  Index inner = 0;
  while (loose.surface.node_slot[inner] >= 0)
  {
    ++inner;
  }
  Points x = loose.mesh.nodes;
  for (const bool number : {true, false})
  {
    field->march(x);
    field->marchUntil(x, {alone, inner});
    EXPECT_TRUE(std::isnan(field->depth()[alone]));
    EXPECT_EQ(field->closestTriangle()[alone], -1);
    EXPECT_EQ(std::isnan(field->depth()[inner]), !number);
    x[inner].y() = std::nan("");
  }
}

}  // namespace
}  // namespace soft_tissue
