#include "soft_tissue_sim/node/map_input.h"

#include <ros/console.h>
#include <ros/time.h>

#include <exception>
#include <utility>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/bounded_allocator.h"
#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
constexpr double kWarningPeriod = 1.0;  // s
constexpr double kTfPoll = 0.01;        // s
}  // namespace

soft_tissue::OctomapData octomapFrom(const octomap_msgs::Octomap& message)
{
  return {message.binary != 0, message.id, message.resolution,
          std::string(message.data.begin(), message.data.end())};
}

MapInput::MapInput(const ros::NodeHandle& node, const soft_tissue::ObstacleConfig& config,
                   const tf2_ros::Buffer& buffer, std::string world_frame, double wait_s, Sink sink)
    : config_(config),
      buffer_(buffer),
      world_frame_(std::move(world_frame)),
      wait_s_(wait_s),
      sink_(std::move(sink)),
      node_(node),
      spinner_(1, &queue_)
{
  node_.setCallbackQueue(&queue_);
  using Bounded = octomap_msgs::Octomap_<BoundedAllocator<void>>;
  const boost::function<void(const boost::shared_ptr<Bounded const>&)> take =
      [this](const boost::shared_ptr<Bounded const>& bounded) {
        octomap_msgs::Octomap message;
        message.header.stamp = bounded->header.stamp;
        message.header.frame_id.assign(bounded->header.frame_id.begin(),
                                       bounded->header.frame_id.end());
        message.binary = bounded->binary;
        message.id.assign(bounded->id.begin(), bounded->id.end());
        message.resolution = bounded->resolution;
        message.data.assign(bounded->data.begin(), bounded->data.end());
        onMap(message);
      };
  subscriber_ = node_.subscribe<Bounded>(config_.octomap.topic, 1, take);
  spinner_.start();
}

void MapInput::onMap(const octomap_msgs::Octomap& message)
{
  try
  {
    soft_tissue::VoxelSet cells = soft_tissue::octomapCells(octomapFrom(message), config_.octomap);
    std::string reason;
    const std::optional<soft_tissue::Pose> X_WF = frameOf(message, reason);
    if (!X_WF)
    {
      reject(without_transform_, reason);
      return;
    }
    sink_(std::move(cells), *X_WF * config_.pose.toPose());
    ++accepted_;
  }
  catch (const soft_tissue::Error& error)
  {
    reject(bad_maps_, error.what());
  }
}

/** A map that was sent once, long ago, is where its frame is now. */
std::optional<soft_tissue::Pose> MapInput::frameOf(const octomap_msgs::Octomap& message,
                                                   std::string& reason) const
{
  const std::string& frame = message.header.frame_id;
  if (frame.empty() || frame == world_frame_)
  {
    return soft_tissue::Pose::Identity();
  }
  const double begun_s = ros::SteadyTime::now().toSec();
  ros::Time stamp = message.header.stamp;
  for (;;)
  {
    const bool may_wait = ros::SteadyTime::now().toSec() - begun_s < wait_s_ && ros::ok();
    stamp = may_wait ? stamp : ros::Time();
    try
    {
      return poseFromMessage(buffer_.lookupTransform(world_frame_, frame, stamp).transform);
    }
    catch (const std::exception& error)  // tf lets those of ros::Time through
    {
      reason = error.what();
    }
    if (!may_wait)
    {
      return std::nullopt;
    }
    ros::WallDuration(kTfPoll).sleep();
  }
}

void MapInput::reject(std::atomic<std::uint64_t>& count, const std::string& reason)
{
  ++count;
  const double now = ros::SteadyTime::now().toSec();
  if (last_warning_s_ < 0.0 || now - last_warning_s_ > kWarningPeriod)
  {
    last_warning_s_ = now;
    ROS_WARN_STREAM("obstacle '" << config_.name << "': map rejected: " << reason << " ("
                                 << badMaps() + withoutTransform() << " rejected so far)");
  }
}

}  // namespace soft_tissue_sim
