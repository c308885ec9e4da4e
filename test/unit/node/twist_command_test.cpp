#include "soft_tissue_sim/node/twist_command.h"

#include <gtest/gtest.h>

#include <cmath>

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Pose;
using soft_tissue::Vec3;

Pose somewhere()
{
  Pose X = Pose::Identity();
  X.translate(Vec3(1, 2, 3)).rotate(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()));
  return X;
}

TEST(TwistCommand, manyStepsInOwnAxesGoRoundACircle)
{
  // Forwards at 0.2 m/s while turning at 2 rad/s: a circle of 0.1 m, once round.
  const Twist twist = {Vec3(0.2, 0, 0), Vec3(0, 0, 2.0), true};
  const int steps = 20000;
  const double h = M_PI / steps;
  Pose X = somewhere();
  Vec3 least = X.translation(), most = X.translation();
  for (int n = 0; n < steps; ++n)
  {
    X = moved(X, twist, h);
    least = least.cwiseMin(X.translation());
    most = most.cwiseMax(X.translation());
  }
  EXPECT_TRUE(X.isApprox(somewhere(), 1e-4));
  EXPECT_NEAR(most.x() - least.x(), 0.2, 1e-4);
  EXPECT_NEAR(most.y() - least.y(), 0.2, 1e-4);
  EXPECT_LT((X.linear().transpose() * X.linear() - soft_tissue::Mat3::Identity()).norm(), 1e-14);
}

TEST(TwistCommand, inTheWorldsAxesTheToolsDoNotCount)
{
  const Pose X = moved(somewhere(), {Vec3(0.1, 0, 0), Vec3(0, 0, 1.0), false}, 0.5);
  EXPECT_LT((X.translation() - Vec3(1.05, 2, 3)).norm(), 1e-15);
  EXPECT_LT((X.linear().col(0) - Vec3(-std::sin(0.5), std::cos(0.5), 0)).norm(), 1e-15);
  EXPECT_TRUE(moved(somewhere(), Twist(), 1.0).isApprox(somewhere(), 0.0));
}

TEST(TwistCommand, eachOfASeriesCountsUntilTheNextOrTheSilence)
{
  TwistSeries commands;
  commands.times_s = {1.0, 1.25, 3.0};
  for (const double v : {1.0, -2.0, 4.0})
  {
    commands.samples.push_back({Vec3(v, 0, 0), Vec3::Zero(), false});
  }
  const auto way = [&](double begin_s, double end_s) {
    return movedAlong(Pose::Identity(), commands, begin_s, end_s, 0.5).translation().x();
  };
  EXPECT_EQ(way(0.0, 1.0), 0.0);
  EXPECT_EQ(way(0.0, 1.25), 0.25);
  EXPECT_EQ(way(1.125, 1.5), 0.125 - 0.5);
  EXPECT_EQ(way(1.5, 1.75), -0.5);
  EXPECT_EQ(way(1.75, 3.0), 0.0) << "silence";
  EXPECT_EQ(way(2.0, 3.25), 1.0);
  EXPECT_EQ(way(0.0, 10.0), 0.25 - 1.0 + 2.0);
  EXPECT_EQ(way(5.0, 6.0), 0.0);
}

TEST(TwistCommand, countsUntilItIsSilentForTooLong)
{
  TwistCommand command;
  EXPECT_FALSE(command.at(0.0, 0.5));
  command.put({Vec3(1, 0, 0), Vec3::Zero(), false}, 10.0);
  EXPECT_TRUE(command.at(10.5, 0.5));
  EXPECT_FALSE(command.at(10.6, 0.5));
  EXPECT_FALSE(command.at(10.1, 0.5)) << "gone for good";
  command.put({Vec3(1, 0, 0), Vec3::Zero(), false}, 10.0);
  EXPECT_FALSE(command.at(9.0, 0.5)) << "the clock went back";
  command.put({Vec3(1, 0, 0), Vec3::Zero(), false}, 10.0);
  command.clear();
  EXPECT_FALSE(command.at(10.0, 0.5));
}

}  // namespace
}  // namespace soft_tissue_sim
