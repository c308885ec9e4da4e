#include "soft_tissue_sim/node/step_schedule.h"

#include <cmath>

namespace soft_tissue_sim
{
StepSchedule::StepSchedule(double step_s, double factor, double max_lag_s)
    : period_(step_s / factor), max_lag_s_(max_lag_s)
{}

void StepSchedule::anchor(double now)
{
  anchor_ = now;
  last_now_ = now;
  done_ = 0;
}

std::int64_t StepSchedule::due(double now)
{
  if (now < last_now_)
  {
    ++jumps_back_;
    anchor(now);
    return 0;
  }
  last_now_ = now;
  // A clock that moves by exactly one period must not miss a step to rounding.
  constexpr double kRounding = 1.0e-4;
  const auto passed = static_cast<std::int64_t>(std::floor((now - anchor_) / period_ + kRounding));
  const std::int64_t due = passed - done_;
  if (due > 1 && static_cast<double>(due) * period_ > max_lag_s_)
  {
    dropped_ += static_cast<std::uint64_t>(due - 1);
    anchor(now);
    anchor_ = now - period_;
    return 1;
  }
  return due;
}

}  // namespace soft_tissue_sim
