#include "soft_tissue_sim/geometry/rigid_shape.h"

#include <gtest/gtest.h>

#include <ostream>

#include "soft_tissue_sim/base/error.h"
#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

constexpr double kPi = 3.14159265358979323846;

struct ShapeCase
{
  std::string name;
  std::shared_ptr<const RigidShape> shape;
  double size;    ///< m, of its largest extent
  double area;    ///< m^2, closed form
  double volume;  ///< m^3, closed form
  bool convex;
  double inner_radius;
  bool curved;  ///< its surface is only approached by triangles
};

std::ostream& operator<<(std::ostream& out, const ShapeCase& c)
{
  return out << c.name;
}

std::shared_ptr<const RigidShape> meshOf(const SurfaceMesh& mesh)
{
  return makeMeshShape(mesh.nodes, mesh.triangles, "test mesh");
}

std::vector<ShapeCase> allShapes()
{
  const double r = 0.004;
  const double l = 0.02;
  return {
      {"sphere", makeSphere(0.01), 0.02, 4 * kPi * 1e-4, 4.0 / 3 * kPi * 1e-6, true, 0.01, true},
      {"capsule", makeCapsule(r, l), l + 2 * r, 4 * kPi * r * r + 2 * kPi * r * l,
       4.0 / 3 * kPi * r * r * r + kPi * r * r * l, true, r, true},
      {"ball_capsule", makeCapsule(r, 0.0), 2 * r, 4 * kPi * r * r, 4.0 / 3 * kPi * r * r * r, true,
       r, true},
      {"box", makeBox({0.02, 0.01, 0.03}), 0.03, 0.0022, 6e-6, true, 0.005, false},
      {"l_prism", meshOf(test::lPrism()), 2.0, 14.0, 3.0, false, 0.5, false},
      {"box_mesh", meshOf(makeBox({1, 2, 3})->surface(0.7)), 3.0, 22.0, 6.0, true, 0.5, false}};
}

class EveryShape : public testing::TestWithParam<ShapeCase>
{
 protected:
  const ShapeCase& c() const { return GetParam(); }
  const RigidShape& shape() const { return *GetParam().shape; }
  SurfaceMesh fine() const { return shape().surface(c().size / 40); }
};

TEST_P(EveryShape, DistanceMatchesBruteForceOverItsFineSurface)
{
  const SurfaceMesh mesh = fine();
  const double allowed = c().curved ? 5e-4 * c().size : 1e-12 * c().size;  // sagitta of the facets
  RandomGeometry random(5);
  for (int trial = 0; trial < 100; ++trial)
  {
    const Vec3 p = random.point(c().size);
    const SignedDistance found = shape().distance(p);
    const double unsigned_distance = test::bruteForceDistance(p, mesh.nodes, mesh.triangles);
    EXPECT_NEAR(std::abs(found.distance), unsigned_distance, allowed);
    if (unsigned_distance > allowed)
    {
      EXPECT_EQ(found.distance<0.0, test::windingNumber(p, mesh)> 0.5) << p.transpose();
    }
  }
}

TEST_P(EveryShape, NormalIsTheGradientOfDistanceAndUnit)
{
  RandomGeometry random(6);
  const double h = 1e-5 * c().size;
  int kinks = 0;
  for (int trial = 0; trial < 500; ++trial)
  {
    const Vec3 p = random.point(c().size);
    const SignedDistance here = shape().distance(p);
    EXPECT_NEAR(here.normal.norm(), 1.0, 1e-12);
    Vec3 difference;
    for (int axis = 0; axis < 3; ++axis)
    {
      difference[axis] = (shape().distance(p + h * Vec3::Unit(axis)).distance -
                          shape().distance(p - h * Vec3::Unit(axis)).distance) /
                         (2 * h);
    }
    kinks += (difference - here.normal).norm() > 1e-4;
  }
  EXPECT_LE(kinks, 2);  // only points astride the medial axis may differ
}

TEST_P(EveryShape, WalkingTheDistanceAlongTheNormalEndsOnTheSurface)
{
  RandomGeometry random(7);
  for (int trial = 0; trial < 500; ++trial)
  {
    const Vec3 p = random.point(c().size);
    const SignedDistance here = shape().distance(p);
    const Vec3 foot = p - here.distance * here.normal;
    EXPECT_LE(std::abs(shape().distance(foot).distance), 1e-12 * c().size);
  }
}

TEST_P(EveryShape, IsFiniteAndUnitOnItsSkeletonAndItsSurface)
{
  Points points = {Vec3::Zero(), Vec3(0, 0, 1e-3 * c().size), Vec3(0, 0, 10 * c().size),
                   Vec3(1e-200, 0, 0), Vec3(-0.0, 0.0, -0.0)};
  const SurfaceMesh mesh = shape().surface(c().size / 8);
  points.insert(points.end(), mesh.nodes.begin(), mesh.nodes.end());
  for (const Triangle& t : mesh.triangles)
  {
    points.push_back(0.5 * (mesh.nodes[t[0]] + mesh.nodes[t[1]]));
  }
  for (const Vec3& p : points)
  {
    const SignedDistance here = shape().distance(p);
    EXPECT_TRUE(std::isfinite(here.distance));
    EXPECT_NEAR(here.normal.norm(), 1.0, 1e-12) << p.transpose();
    EXPECT_EQ(shape().distance(p).normal, here.normal);
  }
}

TEST_P(EveryShape, SurfaceIsClosedOutwardAndOnTheShape)
{
  for (const double cells : {0.3, 2.0, 7.0, 23.0})
  {
    const double max_edge = c().size / cells;
    const SurfaceMesh mesh = shape().surface(max_edge);
    EXPECT_TRUE(test::isClosed(mesh));
    EXPECT_GT(test::enclosedVolume(mesh), 0.0);
    EXPECT_LE(test::longestEdgeOf(mesh), max_edge * (1 + 1e-12));
    for (const Vec3& node : mesh.nodes)
    {
      EXPECT_LE(std::abs(shape().distance(node).distance), 1e-12 * c().size);
    }
  }
}

TEST_P(EveryShape, AreaAndVolumeConvergeToTheClosedForm)
{
  const auto areaError = [&](double cells) {
    return std::abs(test::surfaceArea(shape().surface(c().size / cells)) - c().area) / c().area;
  };
  if (c().curved)
  {
    EXPECT_LT(areaError(20), 0.01);
    EXPECT_LT(areaError(40), areaError(20) / 3.0);  // second order
  }
  else
  {
    EXPECT_LT(areaError(20), 1e-12);
  }
  EXPECT_NEAR(test::enclosedVolume(fine()), c().volume, (c().curved ? 5e-3 : 1e-12) * c().volume);
}

TEST_P(EveryShape, BoundsConvexityAndInnerRadius)
{
  const SurfaceMesh mesh = fine();
  Box3 box;
  for (const Vec3& node : mesh.nodes)
  {
    box.extend(node);
  }
  EXPECT_LE((box.min - shape().bounds().min).cwiseAbs().maxCoeff(), 2e-3 * c().size);
  EXPECT_LE((box.max - shape().bounds().max).cwiseAbs().maxCoeff(), 2e-3 * c().size);
  Box3 grown = shape().bounds();
  grown.grow(1e-12 * c().size);
  EXPECT_TRUE(grown.contains(box.min) && grown.contains(box.max));
  EXPECT_EQ(shape().convex(), c().convex);
  EXPECT_NEAR(shape().innerRadius(), c().inner_radius, 1e-6 * c().size);
}

TEST_P(EveryShape, RefusesAnEdgeLengthThatIsNotPositiveOrFarTooSmall)
{
  EXPECT_THROW(shape().surface(0.0), Error);
  EXPECT_THROW(shape().surface(-1.0), Error);
  EXPECT_THROW(shape().surface(NAN), Error);
  EXPECT_THROW(shape().surface(1e-7 * c().size), Error);
}

TEST_P(EveryShape, CurvatureIsTheDerivativeOfTheNormal)
{
  RandomGeometry random(6);
  const double h = 1e-6 * c().size;
  int compared = 0;
  for (int trial = 0; trial < 200; ++trial)
  {
    const Vec3 p = random.point(c().size);
    const Mat3 curvature = shape().curvature(p);
    Mat3 difference;
    double jump = 0.0;  // between one-sided differences: the nearest feature changes nearby
    for (int axis = 0; axis < 3; ++axis)
    {
      const Vec3 step = h * Vec3::Unit(axis);
      const Vec3 after = shape().distance(p + step).normal, at = shape().distance(p).normal,
                 before = shape().distance(p - step).normal;
      difference.col(axis) = (after - before) / (2.0 * h);
      jump = std::max(jump, (after - 2.0 * at + before).norm());
    }
    if (jump < 1e-8 && std::abs(shape().distance(p).distance) > 0.01 * c().size)
    {
      ++compared;
      EXPECT_LT((curvature - difference).norm() * c().size, 1e-5) << p.transpose();
    }
  }
  EXPECT_GT(compared, 100);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(allShapes()),
                         [](const auto& info) { return info.param.name; });

TEST(RigidShapes, RefuseSizesThatAreNotPositiveAndFinite)
{
  for (const double bad : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)})
  {
    EXPECT_THROW(makeSphere(bad), Error);
    EXPECT_THROW(makeCapsule(bad, 1.0), Error);
    EXPECT_THROW(makeBox({1.0, bad, 1.0}), Error);
  }
  EXPECT_THROW(makeCapsule(1.0, -1e-9), Error);
  EXPECT_THROW(makeCapsule(1.0, NAN), Error);
}

}  // namespace
}  // namespace soft_tissue
