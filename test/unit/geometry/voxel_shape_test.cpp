#include "soft_tissue_sim/geometry/voxel_shape.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstring>

#include "soft_tissue_sim/base/error.h"
#include "support/voxel_samples.h"

namespace soft_tissue
{
namespace
{
using namespace test;

// From how cells may be smoothed: corners move by at most 0.35 cells along each axis.
const double kMostMoved = 0.35 * std::sqrt(3.0);
const CellBox kSix = {Cell::Constant(-3), Cell::Constant(3)};
const CellBox kAround = {Cell::Constant(-4), Cell::Constant(4)};

bool sameBits(const SignedDistance& a, const SignedDistance& b)
{
  return std::memcmp(&a.distance, &b.distance, sizeof(double)) == 0 &&
         std::memcmp(a.normal.data(), b.normal.data(), 3 * sizeof(double)) == 0;
}

TEST(VoxelShape, LeavesFlatFloorsWhereTheyAre)
{
  const VoxelSet cells = voxelsOf(0.01, {Cell(-20, -20, -6), Cell(20, 20, 4)},
                                  [](const Vec3& p) { return p.z() < 0.0; });
  const VoxelShape shape = wholeShape(cells);
  RandomGeometry random(1);
  for (int trial = 0; trial < 500; ++trial)
  {
    const Vec3 p(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.02, 0.02));
    const SignedDistance at = shape.distance(p);
    EXPECT_NEAR(at.distance, p.z(), 1e-16);
    EXPECT_NEAR((at.normal - Vec3::UnitZ()).norm(), 0.0, 1e-12);
    EXPECT_EQ(shape.curvature(p), Mat3::Zero());
  }
}

TEST(VoxelShape, WallsOfOneCellKeepTheirThickness)
{
  const VoxelShape shape = wholeShape(
      voxelsOf(1.0, {Cell(-10, -10, 0), Cell(10, 10, 1)}, [](const Vec3&) { return true; }));
  EXPECT_NEAR(shape.distance({0.3, 0.2, 0.3}).distance, -0.3, 1e-15);
  EXPECT_NEAR(shape.distance({0.3, 0.2, 0.6}).distance, -0.4, 1e-15);
}

// The triangles are its own; what is tested is that the nearest is found, from any patch, with the
// right sign, even where cells touch in edges and corners only.
TEST(VoxelShape, DistanceMatchesBruteForceOverItsSurface)
{
  for (const double share : {0.2, 0.4, 0.6, 0.9})
  {
    const VoxelShape shape = wholeShape(randomVoxels(7, kSix, share));
    const SurfaceMesh surface = shape.surface(10.0);
    ASSERT_GT(surface.triangles.size(), 50u);
    RandomGeometry random(8);
    int inside = 0;
    for (int trial = 0; trial < 300; ++trial)
    {
      const Vec3 p = random.point(4.0);
      const SignedDistance found = shape.distance(p);
      const double expected = bruteForceDistance(p, surface.nodes, surface.triangles);
      EXPECT_NEAR(std::abs(found.distance), expected, 1e-12);
      EXPECT_EQ(found.distance<0.0, windingNumber(p, surface)> 0.5) << p.transpose();
      inside += found.distance < 0.0;
    }
    EXPECT_GT(inside, share > 0.3 ? 0 : -1) << share;  // lone cells are small
  }
}

TEST(VoxelShape, StaysNearTheCubes)
{
  for (const double share : {0.1, 0.4, 0.8})
  {
    const VoxelSet cells = randomVoxels(9, kSix, share);
    const VoxelShape shape = wholeShape(cells);
    RandomGeometry random(10);
    for (int trial = 0; trial < 500; ++trial)
    {
      const Vec3 p = random.point(3.9);
      EXPECT_NEAR(shape.distance(p).distance, distanceToCubes(cells, kAround, p), kMostMoved);
    }
  }
}

TEST(VoxelShape, NormalIsTheGradientOfDistanceAndUnit)
{
  const VoxelShape shape = wholeShape(randomVoxels(11, kSix, 0.5));
  RandomGeometry random(12);
  int kinks = 0;
  for (int trial = 0; trial < 500; ++trial)
  {
    const Vec3 p = random.point(4.0);
    const SignedDistance here = shape.distance(p);
    EXPECT_NEAR(here.normal.norm(), 1.0, 1e-12);
    constexpr double kStep = 1e-6;
    Vec3 difference;
    Mat3 bend;
    for (int axis = 0; axis < 3; ++axis)
    {
      const SignedDistance up = shape.distance(p + kStep * Vec3::Unit(axis));
      const SignedDistance down = shape.distance(p - kStep * Vec3::Unit(axis));
      difference[axis] = (up.distance - down.distance) / (2.0 * kStep);
      bend.col(axis) = (up.normal - down.normal) / (2.0 * kStep);
    }
    const double allowed = 1e-4 * (1.0 + shape.curvature(p).norm());
    kinks +=
        (difference - here.normal).norm() > 1e-4 || (bend - shape.curvature(p)).norm() > allowed;
  }
  EXPECT_LE(kinks, 2);  // only points astride a feature's border may differ
}

// The cubes' own normals are 40 to 53 degrees off.
TEST(VoxelShape, TurnsStairsIntoSlopes)
{
  for (const double slope : {20.0, 30.0, 45.0})
  {
    for (const double turn : {0.0, 25.0})
    {
      const double a = slope * M_PI / 180.0, b = turn * M_PI / 180.0;
      const Vec3 normal(-std::sin(a) * std::cos(b), -std::sin(a) * std::sin(b), std::cos(a));
      const VoxelShape shape =
          wholeShape(voxelsOf(1.0, {Cell::Constant(-18), Cell::Constant(18)},
                              [&](const Vec3& p) { return normal.dot(p) < 0.2; }));
      RandomGeometry random(13);
      double off = 0.0, height = 0.0;
      constexpr int kTrials = 1000;
      for (int trial = 0; trial < kTrials; ++trial)
      {
        Vec3 p = random.point(8.0);
        p += (0.15 - normal.dot(p)) * normal;  // a little inside
        const SignedDistance at = shape.distance(p);
        off += std::pow(std::acos(std::min(1.0, at.normal.dot(normal))), 2) / kTrials;
        height += std::pow(at.distance + 0.05, 2) / kTrials;
      }
      off = std::sqrt(off) * 180.0 / M_PI;
      std::printf("  slope %.0f, turned %.0f: normals %.1f degrees, heights %.3f cells off (rms)\n",
                  slope, turn, off, std::sqrt(height));
      EXPECT_LT(off, 12.0);
      EXPECT_LT(std::sqrt(height), 0.25);
    }
  }
}

TEST(VoxelShape, IsAboutTheBallItWasMadeOf)
{
  const VoxelShape shape = wholeShape(voxelsOf(1.0, {Cell::Constant(-13), Cell::Constant(13)},
                                               [](const Vec3& p) { return p.norm() < 10.0; }));
  RandomGeometry random(14);
  double mean = 0.0;
  for (int trial = 0; trial < 1000; ++trial)
  {
    const double distance = shape.distance(10.0 * random.direction()).distance;
    EXPECT_LT(std::abs(distance), 0.35);
    mean += 1e-3 * distance;
  }
  EXPECT_LT(std::abs(mean), 0.05);
}

TEST(VoxelShape, WhereItWasCoveredFirstChangesNoBit)
{
  const VoxelSet cells = randomVoxels(15, {Cell::Constant(-20), Cell::Constant(20)}, 0.3);
  const VoxelShape whole = wholeShape(cells);
  VoxelShape grown(cells);
  EXPECT_TRUE(grown.cover({Vec3(3.0, 3.0, 3.0), Vec3(5.0, 5.0, 5.0)}));
  EXPECT_TRUE(grown.cover({Vec3(-5.0, -5.0, 3.0), Vec3(-3.0, -3.0, 5.0)}));
  EXPECT_FALSE(grown.cover({Vec3(-5.0, -5.0, 3.0), Vec3(4.0, 4.0, 5.0)}));
  ASSERT_LT(grown.surface(10.0).triangles.size(), whole.surface(10.0).triangles.size());
  RandomGeometry random(16);
  for (int trial = 0; trial < 500; ++trial)
  {
    // Corners and middles of cells too, which are equally near to several triangles.
    Vec3 p(random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), random.uniform(3.0, 9.0));
    p = trial % 2 == 0 ? p : Vec3(0.5 * (2.0 * p).array().round());
    EXPECT_TRUE(sameBits(grown.distance(p), whole.distance(p))) << p.transpose();
  }
}

TEST(VoxelShape, AfterAChangeIsWhatItWouldHaveBeenMadeAs)
{
  const CellBox all = {Cell::Constant(-20), Cell::Constant(20)};
  const VoxelSet cells = randomVoxels(17, all, 0.3);
  const CellBox box = {Cell(-2, 1, -4), Cell(3, 4, 1)};
  VoxelShape changed = wholeShape(cells);
  VoxelSet filled = cells;
  filled.fill(box, true);
  EXPECT_FALSE(changed.changes(cells));
  const std::optional<Box3> where = changed.changes(filled);
  ASSERT_TRUE(where);
  EXPECT_TRUE(where->contains(Vec3(-2.0, 1.0, -4.0)) && where->contains(Vec3(3.0, 4.0, 1.0)));
  EXPECT_EQ(changed.exchange(filled).contents(), cells.contents());
  EXPECT_EQ(changed.cells().contents(), filled.contents());
  const VoxelShape made = wholeShape(filled);
  RandomGeometry random(18);
  for (int trial = 0; trial < 1000; ++trial)
  {
    const Vec3 p = random.point(trial % 2 == 0 ? 8.0 : 20.0);
    EXPECT_TRUE(sameBits(changed.distance(p), made.distance(p))) << p.transpose();
  }
}

// Cells at every distance from patches' borders, and worlds that differ in what is around maps.
TEST(VoxelShape, AfterManyExchangesIsWhatItWouldHaveBeenMadeAs)
{
  const CellBox all = {Cell::Constant(-20), Cell::Constant(20)};
  VoxelShape changed = wholeShape(randomVoxels(19, all, 0.2));
  RandomGeometry random(20);
  for (int round = 0; round < 12; ++round)
  {
    VoxelSet other = round % 4 == 3 ? VoxelSet(1.0, true) : changed.cells();
    const int x = int(random.uniform(-20.0, 17.0)), z = int(random.uniform(-20.0, 17.0));
    other.fill({Cell(x, 15 - round, z), Cell(x + 3, 16, z + 1)}, round % 2 == 0);
    changed.exchange(other);
    VoxelShape made{VoxelSet(1.0)};
    made.remake(other, changed.coveredPatches());
    for (int trial = 0; trial < 200; ++trial)
    {
      const Vec3 p = random.point(20.0);
      EXPECT_TRUE(sameBits(changed.distance(p), made.distance(p)))
          << round << ": " << p.transpose();
    }
  }
}

// Points that go on by little or much, now and then to corners and middles of cells, which are
// equally near to several triangles, while cells change and more is covered.
TEST(VoxelShape, WhatIsRememberedOfAPointChangesNoBit)
{
  const CellBox all = {Cell::Constant(-20), Cell::Constant(20)};
  VoxelShape shape(randomVoxels(21, all, 0.3));
  RigidBodyShape body;
  const auto fixed = std::make_shared<VoxelShape>(wholeShape(randomVoxels(23, all, 0.4)));
  body.add(fixed, Pose::Identity());
  RandomGeometry random(22);
  std::array<NearestHint, 3> hints, of_body;
  int known = 0;
  for (int trial = 0; trial < 6000; ++trial)
  {
    if (trial % 1000 == 0)
    {
      VoxelSet other = shape.cells();
      other.fill({Cell(-3, trial / 1000 - 3, -2), Cell(4, trial / 1000 - 2, 3)}, trial % 2000 == 0);
      shape.exchange(other);
    }
    if (trial % 1500 == 500)
    {
      const double reach = 2.0 + trial / 300.0;
      shape.cover({Vec3::Constant(-reach), Vec3::Constant(reach)});
    }
    NearestHint& hint = hints[trial % 3];
    Vec3 p = hint.at + random.point(trial % 7 == 0 ? 3.0 : trial % 2 == 0 ? 0.2 : 0.01);
    p = trial % 5 == 0 ? Vec3(0.5 * (2.0 * p).array().round()) : p;
    p = p.norm() < 10.0 ? p : random.point(1.0);
    const Vec3 before = hint.at;
    EXPECT_TRUE(sameBits(shape.distance(p, hint), shape.distance(p))) << p.transpose();
    EXPECT_EQ(shape.curvature(p, hint), shape.curvature(p)) << p.transpose();
    known += hint.surface != 0 && hint.at == before && before != p;
    EXPECT_TRUE(sameBits(body.distance(p, of_body[trial % 3]), body.distance(p))) << p.transpose();
    EXPECT_EQ(body.curvature(p, of_body[trial % 3]), body.curvature(p)) << p.transpose();
  }
  EXPECT_TRUE(body.searches());
  EXPECT_GT(known, 2000) << "of 6000 points that took no search";
}

TEST(VoxelShape, FarChangesChangeNothingThatIsCovered)
{
  VoxelSet cells(1.0);
  cells.fill({Cell(0, 0, 0), Cell(200, 200, 2)}, true);
  VoxelShape shape(cells);
  shape.cover({Vec3(1.0, 1.0, 0.0), Vec3(10.0, 10.0, 4.0)});
  cells.set({199, 0, 9}, true);
  shape.exchange(cells);
  cells.fill({Cell(100, 100, 2), Cell(150, 150, 9)}, true);
  EXPECT_FALSE(shape.changes(cells));
  shape.exchange(cells);
  shape.cover({Vec3(110.0, 110.0, 0.0), Vec3(115.0, 115.0, 9.0)});
  EXPECT_NEAR(shape.distance({125.0, 125.0, 10.0}).distance, 1.0, 1e-12);
}

TEST(VoxelShape, SaysWhereCellsOfALargerMapAre)
{
  VoxelShape shape(VoxelSet(0.5));
  VoxelSet cells(0.5);
  EXPECT_FALSE(shape.changes(cells));
  cells.fill({Cell(2, 2, 2), Cell(4, 6, 8)}, true);
  const std::optional<Box3> where = shape.changes(cells);
  ASSERT_TRUE(where);
  EXPECT_EQ(where->min, Vec3(1.0, 1.0, 1.0));
  EXPECT_EQ(where->max, Vec3(2.0, 3.0, 4.0));
  EXPECT_TRUE(shape.changes(VoxelSet(0.5, true)));
}

TEST(VoxelShape, RefusesCellsOfAnotherSize)
{
  VoxelShape shape(VoxelSet(1.0));
  EXPECT_THROW(shape.exchange(VoxelSet(0.5)), Error);
}

TEST(VoxelShape, KnowsInsideFromOutsideWhereNothingIsCovered)
{
  VoxelSet solid(1.0, true);
  solid.fill({Cell::Zero(), Cell::Constant(4)}, false);
  const VoxelShape shape(solid);
  EXPECT_TRUE(std::isinf(shape.distance(Vec3::Constant(2.0)).distance));
  EXPECT_LT(shape.distance(Vec3::Constant(50.0)).distance, -1.0);
  const VoxelShape whole = wholeShape(solid);
  EXPECT_NEAR(whole.distance(Vec3::Constant(2.0)).distance, 2.0, kMostMoved);
  EXPECT_NEAR(whole.distance({2.0, 2.0, 4.5}).distance, -0.5, kMostMoved);
  EXPECT_LT(whole.distance(Vec3::Constant(50.0)).distance, -70.0);
}

}  // namespace
}  // namespace soft_tissue
