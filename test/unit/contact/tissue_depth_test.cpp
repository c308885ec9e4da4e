#include "soft_tissue_sim/contact/tissue_depth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "soft_tissue_sim/geometry/closest_point.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "support/field_oracle.h"
#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

constexpr double kRadius = 0.05;
constexpr double kShortEdge = 0.008;

/** A ball, and points of which it is known in which tets they were. */
struct Ball
{
  test::FieldBody body{makeBall(kRadius, 1000)};
  std::unique_ptr<DistanceField> field = body.field();
  TissueBody tissue;
  std::vector<Index> tets;

  Ball()
  {
    tissue.tets = &body.mesh.tets;
    tissue.surface = &body.surface;
    tissue.node_count = static_cast<Index>(body.mesh.nodes.size());
    tissue.short_edge = kShortEdge;
    for (Index t = 0; t < static_cast<Index>(body.mesh.tets.size()); t += 7)
    {
      tets.push_back(t);
    }
    field->march(body.mesh.nodes);
  }
};

/** Depths of the middles of the ball's tets, by one that remembers and one that does not. */
class Depths
{
 public:
  explicit Depths(const Ball& ball)
      : ball_(ball), depth_(ball.tissue, true), near_(ball.tets.size())
  {}

  /** @return the share of the points that were searched for */
  double compare(const Points& x, const Vec3& off)
  {
    depth_.prepare(x);
    TissueDepth fresh(ball_.tissue, true);
    fresh.prepare(x);
    int searched = 0;
    for (std::size_t i = 0; i < ball_.tets.size(); ++i)
    {
      const Index t = ball_.tets[i];
      const Tet& tet = ball_.body.mesh.tets[t];
      const Vec3 p = 0.25 * (x[tet[0]] + x[tet[1]] + x[tet[2]] + x[tet[3]]) + off;
      ContactSample sample, expected;
      NearBoundary none;
      const Vec3 place = near_[i].place;
      const bool is = depth_.evaluate(p, t, x, *ball_.field, near_[i], sample);
      EXPECT_EQ(is, fresh.evaluate(p, t, x, *ball_.field, none, expected));
      searched += place == near_[i].place ? 0 : 1;
      EXPECT_EQ(sample.depth, expected.depth);
      EXPECT_EQ(sample.gradient, expected.gradient);
      EXPECT_EQ(sample.node, expected.node);
      EXPECT_EQ(sample.coefficient, expected.coefficient);
    }
    return static_cast<double>(searched) / static_cast<double>(ball_.tets.size());
  }

 private:
  const Ball& ball_;
  TissueDepth depth_;
  std::vector<NearBoundary> near_;
};

Points moved(const Ball& ball, const Vec3& shift, double by, RandomGeometry& random)
{
  Points x = ball.body.mesh.nodes;
  for (Vec3& p : x)
  {
    p += shift + by * random.point(1.0).normalized();
  }
  return x;
}

TEST(TissueDepth, RemembersWhatIsNearWithoutAnotherAnswer)
{
  const Ball ball;
  Depths depths(ball);
  RandomGeometry random(5);
  EXPECT_GT(depths.compare(ball.body.mesh.nodes, Vec3::Zero()), 0.9);
  double creeping = 0.0, far = 0.0;
  for (int i = 1; i <= 20; ++i)
  {
    creeping += depths.compare(moved(ball, Vec3::Zero(), 1e-3 * kShortEdge, random), Vec3::Zero());
  }
  for (int i = 1; i <= 20; ++i)
  {
    far += depths.compare(moved(ball, Vec3::Zero(), 0.3 * kShortEdge, random), Vec3::Zero());
  }
  EXPECT_LT(creeping / 20.0, 0.1);
  EXPECT_GT(far / 20.0, 0.5);
}

TEST(TissueDepth, RemembersWhatIsNearWhileAllIsShifted)
{
  const Ball ball;
  Depths depths(ball);
  RandomGeometry random(6);
  depths.compare(ball.body.mesh.nodes, Vec3::Zero());
  double searched = 0.0;
  for (int i = 1; i <= 20; ++i)
  {
    const Vec3 shift = i * Vec3(0.01, -0.02, 0.005);
    searched += depths.compare(moved(ball, shift, 1e-3 * kShortEdge, random), Vec3::Zero());
  }
  EXPECT_LT(searched / 20.0, 0.1);
}

TEST(TissueDepth, RemembersNothingOfPointsThatMoveOn)
{
  const Ball ball;
  Depths depths(ball);
  RandomGeometry random(7);
  for (int i = 0; i <= 20; ++i)
  {
    const Vec3 off = i * 0.1 * kShortEdge * Vec3(1.0, 0.4, -0.2);
    depths.compare(moved(ball, Vec3::Zero(), 0.01 * kShortEdge, random), off);
  }
}

TEST(TissueDepth, GoesOnWhereNothingWasFiniteOrTheTissueCameFar)
{
  const Ball ball;
  Depths depths(ball);
  depths.compare(ball.body.mesh.nodes, Vec3::Zero());
  Points x = ball.body.mesh.nodes;
  x[ball.body.surface.nodes[3]].y() = std::numeric_limits<double>::quiet_NaN();
  TissueDepth lost(ball.tissue, true);
  lost.prepare(ball.body.mesh.nodes);
  lost.prepare(x);
  for (const double far : {0.0, 0.4, 3.0, 1e4})
  {
    Points there = ball.body.mesh.nodes;
    for (Vec3& p : there)
    {
      p.x() += far;
    }
    depths.compare(there, Vec3::Zero());
    lost.prepare(there);
    const Tet& tet = ball.body.mesh.tets[0];
    const Vec3 p = 0.25 * (there[tet[0]] + there[tet[1]] + there[tet[2]] + there[tet[3]]);
    NearBoundary near;
    ContactSample sample;
    ASSERT_TRUE(lost.evaluate(p, 0, there, *ball.field, near, sample));
    EXPECT_TRUE(std::isfinite(sample.depth));
  }
}

/** Depths of the middles of the ball's tets in self-contact, as if points of its surface had come
 * there. */
class SelfDepths
{
 public:
  explicit SelfDepths(const Ball& ball)
      : ball_(ball), depth_(ball.tissue, true), near_(ball.tets.size())
  {}

  /** @param slid  how far points have slid from where they first were on their surface, m
   * @return the share of the points that were searched for */
  double compare(const Points& x, const Vec3& slid)
  {
    const Points& rest = ball_.body.mesh.nodes;
    depth_.prepare(x);
    int searched = 0;
    for (std::size_t i = 0; i < ball_.tets.size(); ++i)
    {
      const Index t = ball_.tets[i];
      const Tet& tet = ball_.body.mesh.tets[t];
      const Vec3 p = 0.25 * (x[tet[0]] + x[tet[1]] + x[tet[2]] + x[tet[3]]);
      const auto coords = tetCoordinates(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]);
      const std::vector<Index>& surface = ball_.body.surface.nodes;
      const Vec3 rest_of = rest[surface[31 * i % surface.size()]] + slid;
      const Vec3 place = near_[i].place;
      ContactSample sample;
      const bool is = depth_.evaluateSelf(p, t, x, *ball_.field, rest, rest_of, near_[i], sample);
      searched += place == near_[i].place ? 0 : 1;
      const double expected = distanceOnThatSide(p, tet, coords->weights(p), x, rest_of);
      EXPECT_EQ(is, std::isfinite(expected));
      if (is)
      {
        EXPECT_NEAR(sample.depth, expected, 1e-12);
      }
    }
    return static_cast<double>(searched) / static_cast<double>(ball_.tets.size());
  }

 private:
  /** To the boundary that is no farther from where p is at rest than from another point there. */
  double distanceOnThatSide(const Vec3& p, const Tet& tet, const Eigen::Vector4d& weights,
                            const Points& x, const Vec3& other) const
  {
    const Points& rest = ball_.body.mesh.nodes;
    Vec3 here = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
    {
      here += weights[k] * rest[tet[k]];
    }
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : ball_.body.surface.triangles)
    {
      const Vec3 centre = (rest[t[0]] + rest[t[1]] + rest[t[2]]) / 3.0;
      if ((centre - here).squaredNorm() <= (centre - other).squaredNorm())
      {
        least = std::min(least, closestOnTriangle(p, x[t[0]], x[t[1]], x[t[2]]).squared_distance);
      }
    }
    return std::sqrt(least);
  }

  const Ball& ball_;
  TissueDepth depth_;
  std::vector<NearBoundary> near_;
};

TEST(TissueDepth, RemembersInSelfContactWithoutAnotherAnswer)
{
  const Ball ball;
  SelfDepths depths(ball);
  RandomGeometry random(8);
  EXPECT_GT(depths.compare(ball.body.mesh.nodes, Vec3::Zero()), 0.9);
  double creeping = 0.0, sliding = 0.0, far = 0.0;
  for (int i = 1; i <= 20; ++i)
  {
    const Vec3 slid = 1e-3 * kShortEdge * random.point(1.0);
    creeping += depths.compare(moved(ball, Vec3::Zero(), 1e-3 * kShortEdge, random), slid);
  }
  for (int i = 1; i <= 20; ++i)
  {
    const Vec3 slid = i * 0.02 * kShortEdge * Vec3(1.0, 0.4, -0.2);
    sliding += depths.compare(moved(ball, Vec3::Zero(), 1e-3 * kShortEdge, random), slid);
  }
  for (int i = 1; i <= 20; ++i)
  {
    far += depths.compare(moved(ball, Vec3::Zero(), 0.3 * kShortEdge, random), Vec3::Zero());
  }
  EXPECT_LT(creeping / 20.0, 0.2);
  EXPECT_LT(sliding / 20.0, 0.6);
  EXPECT_GT(sliding / 20.0, 0.1);
  EXPECT_GT(far / 20.0, 0.5);
}

}  // namespace
}  // namespace soft_tissue
