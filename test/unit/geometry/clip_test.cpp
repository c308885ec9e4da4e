#include "soft_tissue_sim/geometry/clip.h"

#include <gtest/gtest.h>

#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

TetCoordinates unitTet(double unit = 1.0, const Pose& X = Pose::Identity())
{
  return *tetCoordinates(X * Vec3(0, 0, 0), X * Vec3(unit, 0, 0), X * Vec3(0, unit, 0),
                         X * Vec3(0, 0, unit));
}

void expectPiece(const std::optional<ClippedSegment>& piece, double lambda1, double lambda2)
{
  ASSERT_TRUE(piece.has_value());
  EXPECT_NEAR(piece->lambda1, lambda1, 1e-11);
  EXPECT_NEAR(piece->lambda2, lambda2, 1e-11);
}

TEST(ClipSegment, AgreesWithSamplesAlongTheSegment)
{
  RandomGeometry random(1);
  int hits = 0;
  for (int trial = 0; trial < 2000; ++trial)
  {
    const double unit = trial % 2 == 0 ? 1.0 : 1e-3;
    const auto tet = tetCoordinates(unit * random.point(1), unit * random.point(1),
                                    unit * random.point(1), unit * random.point(1));
    ASSERT_TRUE(tet.has_value());
    const Vec3 a = unit * random.point(1);
    const Vec3 b = unit * random.point(1);
    const auto piece = clipSegment(a, b, *tet);
    hits += piece.has_value();
    for (int i = 0; i <= 100; ++i)
    {
      const double lambda = i / 100.0;
      const double least = tet->weights(a + lambda * (b - a)).minCoeff();
      const bool in_piece = piece && lambda >= piece->lambda1 && lambda <= piece->lambda2;
      if (std::abs(least) > 1e-9)
      {
        EXPECT_EQ(in_piece, least > 0.0) << trial << " " << lambda;
      }
    }
    if (piece)
    {
      EXPECT_LE((tet->weights(a + piece->lambda1 * (b - a)) - piece->weights1).norm(), 1e-9);
      EXPECT_LE((tet->weights(a + piece->lambda2 * (b - a)) - piece->weights2).norm(), 1e-9);
      EXPECT_GE(piece->weights1.minCoeff(), -1e-11);
      EXPECT_GE(piece->weights2.minCoeff(), -1e-11);
    }
  }
  EXPECT_GT(hits, 100);
}

class ClipInPose : public testing::TestWithParam<int>
{
 protected:
  ClipInPose() : unit_(std::pow(10.0, -GetParam()))
  {
    RandomGeometry random(GetParam() + 10);
    X_ = GetParam() == 0 ? Pose::Identity() : random.pose(unit_);
    tet_ = unitTet(unit_, X_);
  }
  std::optional<ClippedSegment> clip(const Vec3& a, const Vec3& b) const
  {
    return clipSegment(X_ * (unit_ * a), X_ * (unit_ * b), tet_);
  }

  double unit_;
  Pose X_;
  TetCoordinates tet_;
};

TEST_P(ClipInPose, InsideThroughAndBeside)
{
  expectPiece(clip({0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}), 0, 1);
  expectPiece(clip({-1, 0.25, 0.25}, {1, 0.25, 0.25}), 0.5, 0.75);
  expectPiece(clip({0.25, 0.25, 0.25}, {0.25, 0.25, -0.25}), 0, 0.5);
  EXPECT_FALSE(clip({-1, -0.1, 0.1}, {1, -0.1, 0.1}).has_value());  // parallel to a face, outside
  EXPECT_FALSE(clip({-1, 0.2, 0.2}, {-0.1, 0.2, 0.2}).has_value());
  EXPECT_FALSE(clip({1, 1, 0.5}, {0.5, 1, 1}).has_value());
}

TEST_P(ClipInPose, TouchingCounts)
{
  expectPiece(clip({-1, 0, 0}, {2, 0, 0}), 1.0 / 3, 2.0 / 3);         // along an edge
  expectPiece(clip({-1, 0.25, 0}, {2, 0.25, 0}), 1.0 / 3, 1.75 / 3);  // in a face
  expectPiece(clip({-1, 1, 0}, {1, 1, 0}), 0.5, 0.5);                 // through a corner
  expectPiece(clip({-1, 1, 0.5}, {1, -1, 0.5}), 0.5, 0.5);            // across an edge
  expectPiece(clip({0.25, 0.25, -1}, {0.25, 0.25, 0}), 1, 1);         // ends on a face
}

TEST_P(ClipInPose, SegmentsOfNoLength)
{
  expectPiece(clip({0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}), 0, 1);
  expectPiece(clip({0, 0, 1}, {0, 0, 1}), 0, 1);
  EXPECT_FALSE(clip({1, 1, 1}, {1, 1, 1}).has_value());
}

INSTANTIATE_TEST_SUITE_P(Units, ClipInPose, testing::Values(0, 1, 3, 6));

TEST(ClipSegment, PiecesInNeighbouringTetsAddUp)
{
  // Six tets around the diagonal of a unit cube: a segment's pieces fill its part in the cube.
  const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  RandomGeometry random(3);
  for (int trial = 0; trial < 200; ++trial)
  {
    const Vec3 a = Vec3::Constant(0.5) + random.point(0.5);
    const Vec3 b = Vec3::Constant(0.5) + random.point(0.5);
    double sum = 0.0;
    for (const auto& order : orders)
    {
      const Vec3 first = Vec3::Unit(order[0]);
      const Vec3 second = first + Vec3::Unit(order[1]);
      const auto tet = tetCoordinates(Vec3::Zero(), first, second, Vec3::Ones());
      const auto piece = clipSegment(a, b, *tet);
      sum += piece ? piece->lambda2 - piece->lambda1 : 0.0;
    }
    EXPECT_NEAR(sum, 1.0, 1e-10);
  }
}

}  // namespace
}  // namespace soft_tissue
