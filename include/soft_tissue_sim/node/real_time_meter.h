#pragma once

namespace soft_tissue_sim
{
/** Simulated over wall time, over windows of one second. */
class RealTimeMeter
{
 public:
  /** Forgets the current window, not the last full one: call it after a pause. */
  void restart(double wall_s)
  {
    window_start_s_ = wall_s;
    simulated_s_ = 0.0;
  }

  void stepDone(double wall_s, double step_s)
  {
    simulated_s_ += step_s;
    const double elapsed = wall_s - window_start_s_;
    if (elapsed >= kWindow || !full_window_seen_)
    {
      factor_ = elapsed > 0.0 ? simulated_s_ / elapsed : 0.0;
    }
    if (elapsed >= kWindow)
    {
      full_window_seen_ = true;
      restart(wall_s);
    }
  }

  double factor() const { return factor_; }

 private:
  static constexpr double kWindow = 1.0;  // s
  double window_start_s_ = 0.0;
  double simulated_s_ = 0.0;
  double factor_ = 0.0;
  bool full_window_seen_ = false;
};

}  // namespace soft_tissue_sim
