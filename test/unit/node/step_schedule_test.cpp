#include "soft_tissue_sim/node/step_schedule.h"

#include <gtest/gtest.h>

namespace soft_tissue_sim
{
namespace
{
/** Takes all steps that are due; @return how many. */
int takeDue(StepSchedule& schedule, double now)
{
  int taken = 0;
  while (schedule.due(now) > 0)
  {
    schedule.stepDone();
    ++taken;
  }
  return taken;
}

TEST(StepSchedule, stepsOncePerPeriodInTheLongRun)
{
  StepSchedule schedule(0.005, 1.0, 0.1);
  const double start = 1.7e9;  // today's wall time: rounding must not cost steps
  schedule.anchor(start);
  int taken = 0;
  for (int i = 1; i <= 2000; ++i)
  {
    taken += takeDue(schedule, start + 0.005 * i);
    EXPECT_EQ(taken, i);
  }
  EXPECT_EQ(schedule.dropped(), 0u);
}

TEST(StepSchedule, factorScalesTime)
{
  StepSchedule schedule(0.01, 0.5, 1.0);
  schedule.anchor(0.0);
  EXPECT_EQ(takeDue(schedule, 0.1), 5);
  EXPECT_NEAR(schedule.nextDue(), 0.12, 1e-12);
}

TEST(StepSchedule, smallLagIsCaughtUpAndLargeLagGivenUp)
{
  StepSchedule schedule(0.01, 1.0, 0.1);
  schedule.anchor(0.0);
  EXPECT_EQ(takeDue(schedule, 0.095), 9);
  EXPECT_EQ(takeDue(schedule, 5.0), 1);
  EXPECT_EQ(schedule.dropped(), 490u);
  EXPECT_EQ(takeDue(schedule, 5.005), 0);
  EXPECT_EQ(takeDue(schedule, 5.01), 1);
}

TEST(StepSchedule, aLongStepIsNotADroppedOne)
{
  StepSchedule schedule(1.0, 1.0, 0.1);  // lag below one step counts for nothing
  schedule.anchor(0.0);
  EXPECT_EQ(takeDue(schedule, 1.5), 1);
  EXPECT_EQ(schedule.dropped(), 0u);
}

TEST(StepSchedule, clockThatGoesBackIsFollowedFromThere)
{
  StepSchedule schedule(0.01, 1.0, 10.0);
  schedule.anchor(100.0);
  EXPECT_EQ(takeDue(schedule, 100.055), 5);
  EXPECT_EQ(takeDue(schedule, 3.0), 0);
  EXPECT_EQ(schedule.jumpsBack(), 1u);
  EXPECT_EQ(takeDue(schedule, 3.02), 2);
}

}  // namespace
}  // namespace soft_tissue_sim
