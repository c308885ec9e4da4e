#pragma once

#include <geometry_msgs/Pose.h>
#include <ros/time.h>

#include <algorithm>

namespace soft_tissue_sim
{
/** Why a command is not obeyed. */
enum class Rejection
{
  none,
  not_finite,       ///< NaN or infinity
  not_unit,         ///< the quaternion's norm is off 1 by more than 1e-3
  too_far,          ///< more than 10 m from the origin of its frame or of the world
  unknown_frame,    ///< tf knows no way from its frame to the world
  no_transform,     ///< tf knows the frames but not at the stamp
  stamp_went_back,  ///< older than the command before it
  no_joint,         ///< names no joint of the tool, or has not one position for each name
  other_motion      ///< a link's frame is not where its joint can have it
};
constexpr int kRejectionCount = 9;

/** What the rejection means, for logs and diagnostics. */
const char* rejectionText(Rejection rejection);

/** Checks a pose on its own: finite, unit quaternion, within 10 m. */
Rejection checkPose(const geometry_msgs::Pose& pose);

/** Checks that the stamps of one stream of commands never go back. */
class StampOrder
{
 public:
  /** Zero stamps mean "now" and are always in order. */
  bool accepts(const ros::Time& stamp) const { return stamp.isZero() || stamp >= last_; }
  /** A stamp ahead of the clock counts as `now`: it must not bar those that come in time after it.
   */
  void accept(const ros::Time& stamp, const ros::Time& now)
  {
    last_ = stamp.isZero() ? last_ : std::min(stamp, now);
  }
  /** A new stream may start anywhere. */
  void restart() { last_ = ros::Time(); }

 private:
  ros::Time last_;
};

}  // namespace soft_tissue_sim
