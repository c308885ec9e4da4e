#pragma once

#include <chrono>

namespace soft_tissue
{
/** Wall-clock stop watch on the steady clock. */
class Timer
{
 public:
  Timer() : start_(Clock::now()) {}

  /** Seconds since construction or the last restart(). */
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  /** Seconds since construction or the last restart(), then starts again at zero. */
  double restart()
  {
    const Clock::time_point now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_;
};

/** Adds the seconds of its own lifetime to a sum. */
class ScopedTimer
{
 public:
  explicit ScopedTimer(double& sum_s) : sum_s_(sum_s) {}
  ~ScopedTimer() { sum_s_ += timer_.seconds(); }
  ScopedTimer(const ScopedTimer&) = delete;
  ScopedTimer& operator=(const ScopedTimer&) = delete;

 private:
  double& sum_s_;
  Timer timer_;
};

}  // namespace soft_tissue
