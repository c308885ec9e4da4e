#include "soft_tissue_sim/base/timer.h"

#include <gtest/gtest.h>

namespace soft_tissue
{
namespace
{
using Clock = std::chrono::steady_clock;

/** Lets at least this many seconds go by. */
void spend(double seconds)
{
  const Clock::time_point start = Clock::now();
  while (std::chrono::duration<double>(Clock::now() - start).count() < seconds)
  {}
}

double since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

TEST(Timer, agreesWithTheClockAroundIt)
{
  const Clock::time_point before = Clock::now();
  const Timer timer;
  const Clock::time_point after = Clock::now();
  spend(1.0e-3);
  const double at_least = since(after);
  const double seconds = timer.seconds();
  EXPECT_GE(seconds, at_least);
  EXPECT_LE(seconds, since(before));
}

TEST(Timer, restartsAtZeroAndLosesNothing)
{
  const Clock::time_point before = Clock::now();
  Timer timer;
  spend(1.0e-3);
  const double first = timer.restart();
  spend(1.0e-3);
  const double second = timer.restart();
  EXPECT_GE(first, 1.0e-3);
  EXPECT_GE(second, 1.0e-3);
  EXPECT_LE(first + second, since(before));
}

TEST(ScopedTimer, addsItsLifetimeToTheSum)
{
  double sum = 5.0;
  const Clock::time_point before = Clock::now();
  {
    const ScopedTimer timer(sum);
    spend(1.0e-3);
    EXPECT_EQ(sum, 5.0);
  }
  EXPECT_GE(sum, 5.0 + 1.0e-3);
  EXPECT_LE(sum, 5.0 + since(before) + 1.0e-12);
}

}  // namespace
}  // namespace soft_tissue
