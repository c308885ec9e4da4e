#include <gtest/gtest.h>

#include <iostream>

#include "support/field_meshes.h"
#include "support/field_oracle.h"

namespace soft_tissue
{
namespace
{
using test::FieldBody;
using test::RandomGeometry;

/** Random points in random tets: the share whose descent ends off the exact distance. */
double wrongFraction(const std::string& name, const FieldBody& body, const Points& x)
{
  constexpr int kPoints = 10000;
  RandomGeometry random(1);
  const auto field = body.field();
  field->march(x);
  int wrong = 0;
  double largest = 0.0;
  double deepest = 0.0;
  for (int i = 0; i < kPoints; ++i)
  {
    const Tet& tet = body.mesh.tets[static_cast<std::size_t>(
        random.uniform(0, static_cast<double>(body.mesh.tets.size())))];
    Eigen::Vector4d weights;
    weights << -std::log(random.uniform(1e-9, 1)), -std::log(random.uniform(1e-9, 1)),
        -std::log(random.uniform(1e-9, 1)), -std::log(random.uniform(1e-9, 1));
    weights /= weights.sum();
    Vec3 p = Vec3::Zero();
    Index starts[4];
    for (int k = 0; k < 4; ++k)
    {
      p += weights[k] * x[tet[k]];
      starts[k] = field->closestTriangle()[tet[k]];
    }
    const BoundaryPoint found = descendToBoundary(p, x, body.surface, starts, 4);
    const double exact = test::bruteForceDistance(p, x, body.surface.triangles);
    EXPECT_GE(found.distance, exact);
    EXPECT_NEAR((p - found.point).norm(), found.distance, 1e-15);
    const Triangle& t = body.surface.triangles[found.triangle];
    const Vec3 from_weights =
        found.weights[0] * x[t[0]] + found.weights[1] * x[t[1]] + found.weights[2] * x[t[2]];
    EXPECT_LE((from_weights - found.point).norm(), 1e-15);
    wrong += found.distance > exact * (1 + 1e-12);
    largest = std::max(largest, found.distance - exact);
    deepest = std::max(deepest, exact);
  }
  std::cout << name << ": " << 100.0 * wrong / kPoints << " % of " << kPoints
            << " points off, max error / greatest depth " << largest / deepest << "\n";
  return static_cast<double>(wrong) / kPoints;
}

TEST(DescendToBoundary, FindsTheNearestPointOfBallBoxAndL)
{
  const FieldBody ball(test::ballMesh(10, 0.05));
  EXPECT_LT(wrongFraction("ball", ball, ball.mesh.nodes), 1e-3);
  const FieldBody coarse(test::ballMesh(4, 0.05));
  EXPECT_LT(wrongFraction("coarse ball", coarse, coarse.mesh.nodes), 1e-3);
  const FieldBody box(test::boxMesh({10, 8, 6}, {0.5, 0.4, 0.3}));
  EXPECT_LT(wrongFraction("box", box, box.mesh.nodes), 1e-3);
  const FieldBody arm(test::lMesh(20));
  EXPECT_LT(wrongFraction("L", arm, arm.mesh.nodes), 1e-3);
}

TEST(DescendToBoundary, MissesLittleBesideTheMedialAxisOfCoarseLattices)
{
  // Lattice nodes on the medial axis are equally near to several sides and know one of them; where
  // no node of a tet knows the right one, no descent finds it.
  const FieldBody arm(test::lMesh(10));
  EXPECT_LT(wrongFraction("coarse L", arm, arm.mesh.nodes), 1e-2);
  const FieldBody box(test::boxMesh({15, 12, 9}, {0.5, 0.4, 0.3}));
  EXPECT_LT(wrongFraction("finer box", box, box.mesh.nodes), 1e-2);
}

TEST(DescendToBoundary, CrossesAWholeFaceFromABadStart)
{
  const FieldBody slab(test::boxMesh({12, 12, 2}, {1.2, 1.2, 0.5}));
  const Vec3 p(1.05, 1.04, 0.45);  // nearest to the top
  for (Index start = 0; start < static_cast<Index>(slab.surface.triangles.size()); ++start)
  {
    const BoundaryPoint found = descendToBoundary(p, slab.mesh.nodes, slab.surface, &start, 1);
    const Triangle& t = slab.surface.triangles[start];
    const bool on_top = slab.mesh.nodes[t[0]].z() == 0.5 && slab.mesh.nodes[t[1]].z() == 0.5 &&
                        slab.mesh.nodes[t[2]].z() == 0.5;
    if (on_top)
    {
      EXPECT_NEAR(found.distance, 0.05, 1e-15);
    }
    EXPECT_GE(found.distance, 0.05 - 1e-15);
  }
}

TEST(DescendToBoundary, IgnoresMissingStarts)
{
  const FieldBody ball(test::ballMesh(4, 0.05));
  const Index starts[3] = {-1, 7, -1};
  EXPECT_GE(descendToBoundary(Vec3(0.02, 0, 0), ball.mesh.nodes, ball.surface, starts, 3).triangle,
            0);
  const BoundaryPoint none =
      descendToBoundary(Vec3(0.02, 0, 0), ball.mesh.nodes, ball.surface, starts, 1);
  EXPECT_EQ(none.triangle, -1);
  EXPECT_EQ(none.distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(descendToBoundary(Vec3::Zero(), ball.mesh.nodes, ball.surface, nullptr, 0).triangle,
            -1);
}

TEST(DescendToBoundary, EndsOnDegenerateSurfacesToo)
{
  const FieldBody ball(test::ballMesh(5, 0.05));
  Points flat = ball.mesh.nodes;
  for (Vec3& p : flat)
  {
    p.z() = 0.0;
  }
  const Points point(flat.size(), Vec3(1, 2, 3));
  for (Index start = 0; start < static_cast<Index>(ball.surface.triangles.size()); ++start)
  {
    EXPECT_TRUE(std::isfinite(
        descendToBoundary(Vec3(0.01, 0.02, 0.01), flat, ball.surface, &start, 1).distance));
    EXPECT_EQ(descendToBoundary(Vec3(1, 2, 5), point, ball.surface, &start, 1).distance, 2.0);
  }
}

}  // namespace
}  // namespace soft_tissue
