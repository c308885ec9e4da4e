#include "soft_tissue_sim/base/series.h"

#include <gtest/gtest.h>

#include <cmath>

namespace soft_tissue
{
namespace
{
using soft_tissue::Pose;
using soft_tissue::Vec3;

Pose makePose(double x, double angle_about_z)
{
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(angle_about_z, Vec3::UnitZ()).toRotationMatrix();
  X.translation().x() = x;
  return X;
}

TEST(PoseSeries, isLinearBetweenSamplesAndHeldOutside)
{
  const PoseSeries series{{1.0, 3.0}, {makePose(0.0, 0.0), makePose(2.0, 1.0)}};
  EXPECT_TRUE(series.at(1.5).isApprox(makePose(0.5, 0.25), 1e-14));
  EXPECT_TRUE(series.at(0.0).isApprox(makePose(0.0, 0.0), 1e-14));
  EXPECT_TRUE(series.at(9.0).isApprox(makePose(2.0, 1.0), 1e-14));
  EXPECT_TRUE(series.at(3.0).isApprox(makePose(2.0, 1.0), 1e-14));
}

TEST(PoseSeries, theLastOfSamplesAtOneTimeCounts)
{
  const PoseSeries series{{0.0, 1.0, 1.0, 2.0},
                          {makePose(0, 0), makePose(1, 0), makePose(5, 0), makePose(6, 0)}};
  EXPECT_EQ(series.at(1.0).translation().x(), 5.0);
  EXPECT_NEAR(series.at(0.5).translation().x(), 0.5, 1e-15);
  EXPECT_NEAR(series.at(1.5).translation().x(), 5.5, 1e-15);
}

}  // namespace
}  // namespace soft_tissue
