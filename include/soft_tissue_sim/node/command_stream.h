#pragma once

#include <limits>
#include <mutex>
#include <optional>

#include "soft_tissue_sim/base/series.h"

namespace soft_tissue_sim
{
/**
 * The poses, or joint values, that a tool is commanded to, between the callbacks and the physics
 * thread.
 *
 * Senders and steps have rhythms of their own: the newest pose at each step would move the tool by
 * fits and starts. Poses are read between two commands instead, as late as commands are apart. The
 * delay follows the stream, up to kLongestDelay; a stream slower than that moves in steps.
 */
template <typename Sample>
class CommandStream
{
 public:
  static constexpr double kLongestDelay = 0.05;  ///< s

  /**
   * Leaves a command.
   * @param sent_s     when, by the sender's clock, the tool shall be there; empty: on arrival
   * @param arrival_s  by the physics loop's clock; earlier than the one before: that clock went
   * back
   */
  void put(const Sample& command, std::optional<double> sent_s, double arrival_s);

  /** What counts in a step at this time of the loop's clock; empty before the first command. Times
   * of calls ascend. */
  std::optional<Sample> at(double time_s);

  /** The last command, which counts from now on whatever the time. */
  std::optional<Sample> newest();

  /** Forgets all commands. */
  void clear();

 private:
  double localTime(std::optional<double> sent_s, double arrival_s);
  void keepOnlyNewest();

  std::mutex mutex_;
  soft_tissue::Series<Sample> commands_;  ///< by the loop's clock
  double last_arrival_s_ = 0.0;
  std::optional<double> offset_s_;  ///< loop's clock minus sender's, where the way took least
  double delay_s_ = 0.0;
  double read_s_ = std::numeric_limits<double>::lowest();  ///< where at() last read
};

using PoseStream = CommandStream<soft_tissue::Pose>;
using JointStream = CommandStream<soft_tissue::JointValues>;

/** The time at which steps read commands: it goes as fast as the loop's clock in the long run, but
 * evenly from step to step. */
class CommandClock
{
 public:
  /** @param now_s  when the step begins; @param period_s  what a step moves the clock on by */
  double next(double now_s, double period_s);

  /** The clock jumped, or stood. */
  void restart() { time_s_.reset(); }

 private:
  std::optional<double> time_s_;
};

}  // namespace soft_tissue_sim
