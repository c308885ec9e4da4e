#pragma once

#include <cstdint>

namespace soft_tissue_sim
{
/** Says how many steps are due on a clock that somebody else moves, be it wall time or /clock. */
class StepSchedule
{
 public:
  /**
   * @param step_s     simulated time of a step, s
   * @param factor     simulated seconds per second of the clock, > 0
   * @param max_lag_s  clock seconds the steps may lie behind before the rest is given up
   */
  StepSchedule(double step_s, double factor, double max_lag_s);

  /** Starts anew: the first step is due one period after `now`. */
  void anchor(double now);

  /** Whole steps due at `now`, s; a clock that went back anchors the schedule there. */
  std::int64_t due(double now);

  void stepDone() { ++done_; }

  /** Clock seconds a step takes. */
  double period() const { return period_; }

  /** When on the clock the next step ends. */
  double nextDue() const { return anchor_ + static_cast<double>(done_ + 1) * period_; }

  /** Steps given up so far because they lay too far behind. */
  std::uint64_t dropped() const { return dropped_; }

  /** How often the clock went back. */
  std::uint64_t jumpsBack() const { return jumps_back_; }

 private:
  double period_;  ///< clock seconds a step takes
  double max_lag_s_;
  double anchor_ = 0.0;
  double last_now_ = 0.0;
  std::int64_t done_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t jumps_back_ = 0;
};

}  // namespace soft_tissue_sim
