#include "soft_tissue_sim/node/geometry_conversions.h"

#include <gtest/gtest.h>

#include <cmath>

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Pose;
using soft_tissue::Vec3;

Pose somePose()
{
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  X.translation() = Vec3(0.1, -0.2, 0.3);
  return X;
}

TEST(GeometryConversions, poseSurvivesTheWayThroughAMessage)
{
  const Pose X = somePose();
  EXPECT_TRUE(poseFromMessage(poseMessage(X)).isApprox(X, 1e-14));
  EXPECT_TRUE(poseFromMessage(transformMessage(X)).isApprox(X, 1e-14));
}

TEST(GeometryConversions, nearlyUnitQuaternionIsNormalised)
{
  geometry_msgs::Pose message;
  message.orientation.w = 1.0009;
  EXPECT_TRUE(poseFromMessage(message).linear().isApprox(soft_tissue::Mat3::Identity(), 1e-15));
}

TEST(GeometryConversions, quarterTurnAboutZTurnsBodyForceBack)
{
  Pose X_WT = Pose::Identity();
  X_WT.linear() = Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitZ()).toRotationMatrix();
  const soft_tissue::Wrench wrench_W{Vec3(1.0, 0.0, 2.0), Vec3(0.0, 3.0, 0.0)};
  // The tool's x axis is the world's y axis: a force along world x lies along the tool's -y.
  const geometry_msgs::Wrench body = bodyWrench(wrench_W, X_WT);
  EXPECT_NEAR(body.force.x, 0.0, 1e-15);
  EXPECT_NEAR(body.force.y, -1.0, 1e-15);
  EXPECT_NEAR(body.force.z, 2.0, 1e-15);
  EXPECT_NEAR(body.torque.x, 3.0, 1e-15);
  EXPECT_NEAR(body.torque.y, 0.0, 1e-15);
}

TEST(GeometryConversions, momentDoesNotDependOnWhereTheToolIs)
{
  Pose X_WT = somePose();
  const soft_tissue::Wrench wrench_W{Vec3(1.0, 2.0, 3.0), Vec3(-0.1, 0.2, 0.3)};
  const geometry_msgs::Wrench here = bodyWrench(wrench_W, X_WT);
  X_WT.translation() += Vec3(1.0, 1.0, 1.0);
  const geometry_msgs::Wrench there = bodyWrench(wrench_W, X_WT);
  EXPECT_EQ(here.torque.x, there.torque.x);
  EXPECT_EQ(here.torque.y, there.torque.y);
  EXPECT_EQ(here.torque.z, there.torque.z);
}

TEST(GeometryConversions, spatialWrenchHasWorldAxes)
{
  const geometry_msgs::Wrench spatial = spatialWrench({Vec3(1.0, 2.0, 3.0), Vec3(4.0, 5.0, 6.0)});
  EXPECT_EQ(spatial.force.z, 3.0);
  EXPECT_EQ(spatial.torque.x, 4.0);
}

}  // namespace
}  // namespace soft_tissue_sim
