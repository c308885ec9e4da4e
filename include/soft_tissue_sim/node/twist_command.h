#pragma once

#include <mutex>
#include <optional>

#include "soft_tissue_sim/base/series.h"

namespace soft_tissue_sim
{
/** How fast a frame goes: the velocity of its origin, and how it turns. */
struct Twist
{
  soft_tissue::Vec3 linear = soft_tissue::Vec3::Zero();   ///< m/s
  soft_tissue::Vec3 angular = soft_tissue::Vec3::Zero();  ///< rad/s
  bool in_own_axes = false;                               ///< else in the world's
};

/** Where a frame is after going on for so long, s: exactly so while its velocity and turn rate
 * stay the same in the axes they are given in, for the rotation; its origin goes straight. */
soft_tissue::Pose moved(const soft_tissue::Pose& X_WT, const Twist& twist, double duration_s);

using TwistSeries = soft_tissue::Series<Twist>;

/**
 * Where a frame is at the end of a span of time, s, in which each command counts from its time to
 * that of the next, but for `hold_s` at most.
 */
soft_tissue::Pose movedAlong(const soft_tissue::Pose& X_WT, const TwistSeries& commands,
                             double begin_s, double end_s, double hold_s);

/** The velocity command for one tool, between the callbacks and the physics thread. */
class TwistCommand
{
 public:
  /** Leaves a command. @param arrival_s  by the physics loop's clock */
  void put(const Twist& twist, double arrival_s);

  /**
   * The command that counts in a step.
   * @param now_s   by the same clock
   * @param hold_s  silence after which none does; nor where the clock went back
   */
  std::optional<Twist> at(double now_s, double hold_s);

  void clear();

 private:
  std::mutex mutex_;
  std::optional<Twist> twist_;
  double arrival_s_ = 0.0;
};

}  // namespace soft_tissue_sim
