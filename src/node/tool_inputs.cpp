#include "soft_tissue_sim/node/tool_inputs.h"

#include <exception>
#include <utility>

namespace soft_tissue_sim
{
Rejection PoseInput::check(const geometry_msgs::PoseStamped& command) const
{
  return checkPose(command.pose);
}

Rejection PoseInput::take(const geometry_msgs::PoseStamped& command, const soft_tissue::Pose& X_WF)
{
  const soft_tissue::Pose X_WT = X_WF * poseFromMessage(command.pose);
  const Rejection rejection = checkPose(poseMessage(X_WT));
  if (rejection == Rejection::none)
  {
    gate_.accept(X_WT, command.header.stamp);
  }
  return rejection;
}

Rejection TwistInput::check(const geometry_msgs::TwistStamped& command) const
{
  const soft_tissue::Vec3 linear = vectorFromMessage(command.twist.linear);
  const soft_tissue::Vec3 angular = vectorFromMessage(command.twist.angular);
  return linear.allFinite() && angular.allFinite() ? Rejection::none : Rejection::not_finite;
}

bool TwistInput::isKnown(const std::string& frame) const
{
  return frame == tool_frame_ || StampedInput::isKnown(frame);
}

Rejection TwistInput::take(const geometry_msgs::TwistStamped& command,
                           const soft_tissue::Pose& X_WF)
{
  Twist twist;
  twist.linear = X_WF.linear() * vectorFromMessage(command.twist.linear);
  twist.angular = X_WF.linear() * vectorFromMessage(command.twist.angular);
  twist.in_own_axes = command.header.frame_id == tool_frame_;
  gate_.accept(twist, command.header.stamp);
  return Rejection::none;
}

TfInput::TfInput(std::string frame, PoseGate& gate, const tf2::BufferCore& buffer,
                 std::string world_frame, double patience_s)
    : frame_(std::move(frame)),
      gate_(gate),
      buffer_(buffer),
      world_frame_(std::move(world_frame)),
      patience_s_(patience_s)
{}

void TfInput::poll()
{
  geometry_msgs::TransformStamped X_WT;
  try
  {
    X_WT = buffer_.lookupTransform(world_frame_, frame_, ros::Time());
  }
  catch (const std::exception& error)  // tf lets those of ros::Time through
  {
    onMissing(error.what());
    return;
  }
  missing_since_s_.reset();
  missing_reported_ = false;
  const bool is_static = X_WT.header.stamp.isZero();
  if (!is_static && gate_.accepted() > 0 && X_WT.header.stamp == last_stamp_)
  {
    return;
  }
  last_stamp_ = X_WT.header.stamp;
  const soft_tissue::Pose pose = poseFromMessage(X_WT.transform);
  const Rejection rejection = checkPose(poseMessage(pose));
  if (rejection != Rejection::none)
  {
    gate_.reject(rejection, "frame " + frame_);
    return;
  }
  gate_.accept(pose, X_WT.header.stamp);
}

void TfInput::onMissing(const std::string& reason)
{
  const double now = ros::SteadyTime::now().toSec();
  missing_since_s_ = missing_since_s_.value_or(now);
  if (!missing_reported_ && now - *missing_since_s_ >= patience_s_)
  {
    missing_reported_ = true;
    gate_.reject(Rejection::unknown_frame, "frame '" + frame_ + "': " + reason);
  }
}

}  // namespace soft_tissue_sim
