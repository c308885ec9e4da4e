#include "soft_tissue_sim/geometry/tet_overlap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/geometry_oracle.h"
#include "support/tet_overlap_oracle.h"

namespace soft_tissue::test
{
namespace
{
using Corners = std::array<Vec3, 4>;

WholeTet randomTet(RandomGeometry& random, int extent)
{
  WholeTet tet;
  for (auto& corner : tet)
  {
    for (std::int64_t& coordinate : corner)
    {
      coordinate = static_cast<std::int64_t>(std::floor(random.uniform(0.0, extent + 1.0)));
    }
  }
  return tet;
}

Corners cornersOf(const WholeTet& tet, double unit = 1.0, double shift = 0.0)
{
  Corners corners;
  for (int k = 0; k < 4; ++k)
  {
    corners[k] = unit * Vec3(tet[k][0] + shift, tet[k][1] + shift, tet[k][2] + shift);
  }
  return corners;
}

bool isFlat(const WholeTet& tet)
{
  const Corners p = cornersOf(tet);
  return (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) == 0.0;
}

Corners moved(const Corners& corners, const Pose& X)
{
  return {X * corners[0], X * corners[1], X * corners[2], X * corners[3]};
}

const Corners kUnit = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
}  // namespace

TEST(TetsOverlap, OracleKnowsPlainCases)
{
  const WholeTet tet = {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}}};
  const WholeTet inside = {{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}}};
  const WholeTet at_face = {{{3, 3, 3}, {9, 9, 9}, {9, 9, 8}, {9, 8, 9}}};
  const WholeTet beside = {{{3, 3, 4}, {9, 9, 9}, {9, 9, 8}, {9, 8, 9}}};
  const WholeTet point = {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
  EXPECT_TRUE(exactlyOverlap(tet, tet));
  EXPECT_TRUE(exactlyOverlap(tet, inside));
  EXPECT_TRUE(exactlyOverlap(inside, tet));
  EXPECT_TRUE(exactlyOverlap(tet, at_face));
  EXPECT_FALSE(exactlyOverlap(tet, beside));
  EXPECT_TRUE(exactlyOverlap(tet, point));
  EXPECT_TRUE(exactlyOverlap(point, point));
  EXPECT_FALSE(exactlyOverlap(beside, point));
}

// Few whole coordinates: corners, edges and faces that touch or are parallel, flat tets, lines and
// points come by the hundred.
TEST(TetsOverlap, IsExactOnWholeNumbers)
{
  RandomGeometry random(1);
  for (const int extent : {1, 2, 3, 5, 9, 150})
  {
    int overlaps = 0, flat_pairs = 0, flat_overlaps = 0;
    constexpr int kTrials = 3000;
    for (int trial = 0; trial < kTrials; ++trial)
    {
      WholeTet a = randomTet(random, extent), b = randomTet(random, extent);
      if (trial % 4 == 3)  // both in one plane, or on one line
      {
        for (int k = 0; k < 4; ++k)
        {
          a[k][2] = a[k][0] + (trial % 8 == 7 ? 0 : a[k][1]);
          b[k][2] = b[k][0] + (trial % 8 == 7 ? 0 : b[k][1]);
          a[k][1] = trial % 16 == 15 ? 2 * a[k][0] : a[k][1];
          b[k][1] = trial % 16 == 15 ? 2 * b[k][0] : b[k][1];
        }
      }
      const bool truth = exactlyOverlap(a, b);
      overlaps += truth;
      flat_pairs += isFlat(a) && isFlat(b);
      flat_overlaps += truth && isFlat(a) && isFlat(b);
      EXPECT_EQ(tetsOverlap(cornersOf(a), cornersOf(b)), truth) << extent << " " << trial;
      EXPECT_EQ(tetsOverlap(cornersOf(b), cornersOf(a)), truth) << extent << " " << trial;
      // Exact in doubles as well: other units, and far away.
      EXPECT_EQ(tetsOverlap(cornersOf(a, 0x1p-20), cornersOf(b, 0x1p-20)), truth);
      EXPECT_EQ(tetsOverlap(cornersOf(a, 0x1p+30, 1e6), cornersOf(b, 0x1p+30, 1e6)), truth);
    }
    EXPECT_GT(overlaps, kTrials / 20);
    EXPECT_LT(overlaps, kTrials - kTrials / 20);
    EXPECT_GT(flat_pairs, kTrials / 10);
    EXPECT_GT(flat_overlaps, 0);
  }
}

TEST(TetsOverlap, IsTheSameInAnyPose)
{
  RandomGeometry random(2);
  for (int trial = 0; trial < 2000; ++trial)
  {
    const WholeTet a = randomTet(random, 6);
    WholeTet b = randomTet(random, 6);
    b[0] = trial % 2 == 0 ? a[trial % 4] : b[0];  // a corner in common
    const Pose X = random.pose(10.0);
    EXPECT_EQ(tetsOverlap(moved(cornersOf(a), X), moved(cornersOf(b), X)), exactlyOverlap(a, b))
        << trial;
  }
}

TEST(TetsOverlap, GapsAboveTheToleranceCount)
{
  for (const double unit : {1e-6, 1.0, 1e6})
  {
    for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1)})
    {
      Corners a = kUnit, near = kUnit, apart = kUnit;
      const double reach = 1.0 / direction.sum();  // how far the tet extends that way
      for (int k = 0; k < 4; ++k)
      {
        a[k] *= unit;
        near[k] = unit * (2.0 * reach * (1.0 + 1e-14) * direction - kUnit[k]);
        apart[k] = unit * (2.0 * reach * (1.0 + 1e-9) * direction - kUnit[k]);
      }
      EXPECT_TRUE(tetsOverlap(a, near)) << unit << " " << direction.transpose();
      EXPECT_FALSE(tetsOverlap(a, apart)) << unit << " " << direction.transpose();
    }
  }
}

TEST(TetsOverlap, WhatIsNoNumberOverlapsNothing)
{
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      Corners broken = kUnit;
      broken[corner].y() = bad;
      EXPECT_FALSE(tetsOverlap(broken, kUnit));
      EXPECT_FALSE(tetsOverlap(kUnit, broken));
    }
  }
}

}  // namespace soft_tissue::test
