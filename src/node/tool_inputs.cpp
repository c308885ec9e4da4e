#include "soft_tissue_sim/node/tool_inputs.h"

#include <utility>

#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
constexpr std::size_t kMaxWaiting = 200;
}  // namespace

TopicInput::TopicInput(ros::NodeHandle& node, const std::string& topic, CommandGate& gate,
                       const tf2_ros::Buffer& buffer, std::string world_frame, double wait_s)
    : gate_(gate),
      buffer_(buffer),
      world_frame_(std::move(world_frame)),
      wait_s_(wait_s),
      subscriber_(node.subscribe(topic, 1, &TopicInput::onCommand, this,
                                 ros::TransportHints().tcpNoDelay()))
{}

void TopicInput::onCommand(const geometry_msgs::PoseStamped::ConstPtr& command)
{
  if (gate_.stale())
  {
    order_.restart();
  }
  const Rejection rejection = checkPose(command->pose);
  if (rejection != Rejection::none)
  {
    gate_.reject(rejection, "");
    return;
  }
  if (!order_.accepts(command->header.stamp))
  {
    gate_.reject(Rejection::stamp_went_back, "");
    return;
  }
  const Resolved resolved = resolve(*command, wait_s_ > 0.0);
  if (resolved != Resolved::refused)
  {
    order_.accept(command->header.stamp, ros::Time::now());
  }
  if (resolved == Resolved::not_yet)
  {
    if (waiting_.size() == kMaxWaiting)
    {
      gate_.reject(Rejection::no_transform, "too many commands wait for tf");
      waiting_.pop_front();
    }
    waiting_.push_back({command, ros::SteadyTime::now().toSec()});
  }
}

void TopicInput::poll()
{
  const double now = ros::SteadyTime::now().toSec();
  while (!waiting_.empty())
  {
    const bool may_wait = now - waiting_.front().since_s < wait_s_;
    if (resolve(*waiting_.front().command, may_wait) == Resolved::not_yet)
    {
      return;
    }
    waiting_.pop_front();
  }
}

TopicInput::Resolved TopicInput::resolve(const geometry_msgs::PoseStamped& command, bool may_wait)
{
  const std::string& frame = command.header.frame_id;
  soft_tissue::Pose X_WT = poseFromMessage(command.pose);
  if (!frame.empty() && frame != world_frame_)
  {
    try
    {
      const geometry_msgs::TransformStamped X_WF =
          buffer_.lookupTransform(world_frame_, frame, command.header.stamp);
      X_WT = poseFromMessage(X_WF.transform) * X_WT;
    }
    catch (const tf2::ExtrapolationException& error)
    {
      if (may_wait)
      {
        return Resolved::not_yet;
      }
      gate_.reject(Rejection::no_transform, error.what());
      return Resolved::refused;
    }
    catch (const tf2::TransformException& error)
    {
      gate_.reject(Rejection::unknown_frame, error.what());
      return Resolved::refused;
    }
    const Rejection rejection = checkPose(poseMessage(X_WT));
    if (rejection != Rejection::none)
    {
      gate_.reject(rejection, "in the world frame");
      return Resolved::refused;
    }
  }
  gate_.accept(X_WT, command.header.stamp);
  return Resolved::yes;
}

TfInput::TfInput(std::string frame, CommandGate& gate, const tf2_ros::Buffer& buffer,
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
  catch (const tf2::TransformException& error)
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
