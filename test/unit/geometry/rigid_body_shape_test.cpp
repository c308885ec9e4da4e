#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"
#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

TEST(RigidBodyShape, IsTheUnionOfItsPosedParts)
{
  RandomGeometry random(1);
  const Pose X_TA = random.pose(0.1);
  const Pose X_TB = random.pose(0.1);
  const auto a = makeCapsule(0.02, 0.1);
  const auto b = makeBox({0.05, 0.1, 0.2});
  RigidBodyShape body;
  body.add(a, X_TA);
  EXPECT_TRUE(body.convex());
  body.add(b, X_TB);
  EXPECT_FALSE(body.convex());
  EXPECT_DOUBLE_EQ(body.innerRadius(), 0.02);
  for (int trial = 0; trial < 300; ++trial)
  {
    const Vec3 p = random.point(0.3);
    const SignedDistance found = body.distance(p);
    NearestHint hint;
    EXPECT_EQ(body.distance(p, hint).distance, found.distance);
    EXPECT_EQ(hint.surface, 0U) << "it is of one part only";
    const SignedDistance to_a = a->distance(X_TA.inverse() * p);
    const SignedDistance to_b = b->distance(X_TB.inverse() * p);
    EXPECT_NEAR(found.distance, std::min(to_a.distance, to_b.distance), 1e-15);
    const Vec3 expected =
        to_a.distance < to_b.distance ? X_TA.linear() * to_a.normal : X_TB.linear() * to_b.normal;
    EXPECT_LE((found.normal - expected).norm(), 1e-14);
    const Mat3 of_a = X_TA.linear() * a->curvature(X_TA.inverse() * p) * X_TA.linear().transpose();
    const Mat3 of_b = X_TB.linear() * b->curvature(X_TB.inverse() * p) * X_TB.linear().transpose();
    EXPECT_LE((body.curvature(p) - (to_a.distance < to_b.distance ? of_a : of_b)).norm(),
              1e-12 * (1.0 + of_a.norm() + of_b.norm()));
  }
  const SurfaceMesh mesh = body.surface(0.01);
  EXPECT_EQ(mesh.triangles.size(),
            a->surface(0.01).triangles.size() + b->surface(0.01).triangles.size());
  EXPECT_TRUE(test::isClosed(mesh));
  EXPECT_GT(test::enclosedVolume(mesh), 0.0);
  for (const Vec3& node : mesh.nodes)
  {
    EXPECT_LE(body.distance(node).distance, 1e-12);
    EXPECT_TRUE(body.bounds().contains(node));
  }
}

TEST(RigidBodyShape, EmptyBodyIsInfinitelyFar)
{
  const RigidBodyShape body;
  EXPECT_TRUE(body.empty());
  EXPECT_EQ(body.distance(Vec3::Zero()).distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(body.curvature(Vec3::Zero()), Mat3::Zero());
  EXPECT_EQ(body.innerRadius(), 0.0);
  EXPECT_TRUE(body.surface(0.1).nodes.empty());
  EXPECT_FALSE(body.convex());
}

TEST(RigidBodyShape, RefusesMissingShapesAndPosesThatAreNotRigid)
{
  RigidBodyShape body;
  EXPECT_THROW(body.add(nullptr, Pose::Identity()), Error);
  Pose X = Pose::Identity();
  X.linear() *= 1.01;
  EXPECT_THROW(body.add(makeSphere(1.0), X), Error);
  X = Pose::Identity();
  X.linear()(2, 2) = -1.0;
  EXPECT_THROW(body.add(makeSphere(1.0), X), Error);
  X = Pose::Identity();
  X.translation().x() = NAN;
  EXPECT_THROW(body.add(makeSphere(1.0), X), Error);
  EXPECT_TRUE(body.empty());
}

}  // namespace
}  // namespace soft_tissue
