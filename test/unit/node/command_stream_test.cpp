#include "soft_tissue_sim/node/command_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Pose;

constexpr double kPeriod = 0.005;  // s, of commands
constexpr double kSpeed = 0.1;     // m/s

Pose heightOf(double z)
{
  return Pose(Eigen::Translation3d(0.0, 0.0, z));
}

TEST(CommandStream, hasNoPoseBeforeTheFirstCommand)
{
  PoseStream stream;
  EXPECT_FALSE(stream.at(1.0));
  EXPECT_FALSE(stream.newest());
  stream.put(heightOf(0.1), std::nullopt, 1.0);
  EXPECT_TRUE(stream.at(1.0));
  stream.clear();
  EXPECT_FALSE(stream.at(2.0));
}

TEST(CommandStream, ASingleCommandCountsAtOnceAndIsHeld)
{
  PoseStream stream;
  stream.put(heightOf(0.1), std::nullopt, 1.0);
  EXPECT_EQ(stream.at(0.9)->translation().z(), 0.1);
  EXPECT_EQ(stream.at(1000.0)->translation().z(), 0.1);
}

/** A tool at constant speed, commanded every kPeriod, on a way that takes 1 to 3 ms. */
struct JitteryWay
{
  std::vector<double> sent_s, arrival_s;

  explicit JitteryWay(double least_s = 0.001, double most_s = 0.003)
  {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> way(least_s, most_s);
    for (int i = 0; i < 2000; ++i)
    {
      sent_s.push_back(i * kPeriod);
      arrival_s.push_back(std::max(sent_s.back() + way(random), i > 0 ? arrival_s.back() : 0.0));
    }
  }
};

/** Largest difference of a step's move from an even pace, as a share, once the stream is known; and
 * the largest lag behind the sender, s. */
std::pair<double, double> unevenness(bool stamped, double sender_clock, double step_s)
{
  const JitteryWay way;
  PoseStream stream;
  std::size_t next = 0;
  double last = 0.0, uneven = 0.0, lag = 0.0;
  for (double now = 0.02; now < 9.0; now += step_s)
  {
    for (; way.arrival_s[next] <= now; ++next)
    {
      const double sent_s = way.sent_s[next];
      stream.put(heightOf(kSpeed * sent_s),
                 stamped ? std::make_optional(sent_s + sender_clock) : std::nullopt,
                 way.arrival_s[next]);
    }
    const double z = stream.at(now)->translation().z();
    if (now > 2.0)
    {
      uneven = std::max(uneven, std::abs((z - last) / (kSpeed * step_s) - 1.0));
      lag = std::max(lag, now - z / kSpeed);
    }
    last = z;
  }
  return {uneven, lag};
}

TEST(CommandStream, MovesEvenlyBetweenCommandsThatComeUnevenly)
{
  for (const double step_s : {0.002, 0.005, 0.0073, 0.01})
  {
    for (const double sender_clock : {0.0, 1e6, -50.0})
    {
      const auto [uneven, lag] = unevenness(true, sender_clock, step_s);
      EXPECT_LT(uneven, 0.08) << step_s;
      EXPECT_LT(lag, 2.5 * kPeriod);
    }
    const auto [uneven, lag] = unevenness(false, 0.0, step_s);
    EXPECT_LT(uneven, 0.002 / std::min(step_s, kPeriod) + 0.05) << "the way's own jitter stays";
    EXPECT_LT(lag, 2.5 * kPeriod);
  }
}

TEST(CommandStream, EndsExactlyAtTheLastCommand)
{
  PoseStream stream;
  for (int i = 0; i <= 100; ++i)
  {
    stream.put(heightOf(0.001 * i), i * kPeriod, 50.0 + i * kPeriod);
  }
  EXPECT_EQ(stream.at(50.0 + 101.5 * kPeriod)->translation().z(), 0.1);
}

TEST(CommandStream, ASlowStreamIsNotWaitedFor)
{
  PoseStream stream;
  for (int i = 0; i < 5; ++i)
  {
    stream.put(heightOf(i), std::nullopt, i);
    EXPECT_EQ(stream.at(i)->translation().z(), i) << "no delay for one command a second";
  }
}

TEST(CommandStream, NeverTurnsBackBecauseAStreamBecomesSlower)
{
  PoseStream stream;
  double now = 0.0, last = 0.0;
  for (const double period : {0.002, 0.02, 0.045})
  {
    for (int i = 0; i < 50; ++i)
    {
      now += period;
      stream.put(heightOf(now), now, now);
      for (const double part : {0.0, 0.3, 0.7})
      {
        const double z = stream.at(now + part * period)->translation().z();
        EXPECT_GE(z, last);
        last = z;
      }
    }
  }
}

TEST(CommandStream, SurvivesClocksThatGoBack)
{
  PoseStream stream;
  for (int i = 0; i < 100; ++i)
  {
    stream.put(heightOf(i), 10.0 + i * kPeriod, 20.0 + i * kPeriod);
  }
  EXPECT_EQ(stream.newest()->translation().z(), 99.0);
  EXPECT_EQ(stream.at(3.0)->translation().z(), 99.0) << "the newest holds after a jump";
  stream.put(heightOf(7.0), 1.0, 5.0);
  EXPECT_EQ(stream.at(5.0 + PoseStream::kLongestDelay)->translation().z(), 7.0);
  // The sender alone starts over, as a bag played in a loop does.
  for (int round = 0; round < 3; ++round)
  {
    for (int i = 0; i < 100; ++i)
    {
      const double now = 6.0 + round + i * kPeriod;
      stream.put(heightOf(i), i * kPeriod, now);
      if (i > 20)
      {
        EXPECT_NEAR(stream.at(now)->translation().z(), i - 1.0, 1e-6);
      }
    }
  }
}

TEST(CommandClock, GoesEvenlyWhereStepsDoNot)
{
  constexpr double kStep = 0.01;
  CommandClock clock;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> late(0.0, 0.004);
  double last = clock.next(100.0, kStep);
  for (int i = 1; i < 500; ++i)
  {
    const double due = 100.0 + i * kStep;
    const double time = clock.next(due + late(random), kStep);
    EXPECT_NEAR(time - last, kStep, 0.1 * 0.004);
    EXPECT_NEAR(time, due + 0.002, 0.003);
    last = time;
  }
}

TEST(CommandClock, FollowsStepsThatTakeLongerAndJumps)
{
  constexpr double kStep = 0.01;
  CommandClock clock;
  double now = 0.0, last = clock.next(now, kStep);
  for (int i = 0; i < 200; ++i)
  {
    now += 1.5 * kStep;
    const double time = clock.next(now, kStep);
    EXPECT_LT(time - last, 1.5 * kStep + 1e-12);
    EXPECT_GE(time - last, kStep);
    last = time;
  }
  EXPECT_NEAR(last, now, 0.051) << "behind by what is made up for";
  EXPECT_EQ(clock.next(now + 60.0, kStep), now + 60.0);
  clock.restart();
  EXPECT_EQ(clock.next(5.0, kStep), 5.0);
}

}  // namespace
}  // namespace soft_tissue_sim
