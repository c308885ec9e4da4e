#include "soft_tissue_sim/contact/tissue_depth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

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
      const auto coords = tetCoordinates(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]);
      ContactSample sample, expected;
      NearBoundary none;
      const Vec3 place = near_[i].place;
      const bool is = depth_.evaluate(p, t, *coords, x, *ball_.field, near_[i], sample);
      EXPECT_EQ(is, fresh.evaluate(p, t, *coords, x, *ball_.field, none, expected));
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
    const auto coords = tetCoordinates(there[tet[0]], there[tet[1]], there[tet[2]], there[tet[3]]);
    NearBoundary near;
    ContactSample sample;
    ASSERT_TRUE(lost.evaluate(p, 0, *coords, there, *ball.field, near, sample));
    EXPECT_TRUE(std::isfinite(sample.depth));
  }
}

}  // namespace
}  // namespace soft_tissue
