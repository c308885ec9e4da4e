#pragma once

#include <octomap_msgs/Octomap.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <tf2_ros/buffer.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "soft_tissue_sim/scene/config.h"
#include "soft_tissue_sim/scene/octomap_data.h"

namespace soft_tissue_sim
{
/** What a message carries. */
soft_tissue::OctomapData octomapFrom(const octomap_msgs::Octomap& message);

/** Takes an obstacle's maps from a topic, in a thread of its own: decoding one takes long. */
class MapInput
{
 public:
  /** Takes what is good, and where the obstacle's frame is in the world. */
  using Sink = std::function<void(soft_tissue::VoxelSet cells, const soft_tissue::Pose& X_WO)>;

  /** @param wait_s  how long a map may wait for the transform at its stamp */
  MapInput(const ros::NodeHandle& node, const soft_tissue::ObstacleConfig& config,
           const tf2_ros::Buffer& buffer, std::string world_frame, double wait_s, Sink sink);

  const std::string& obstacle() const { return config_.name; }
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t badMaps() const { return bad_maps_; }
  std::uint64_t withoutTransform() const { return without_transform_; }

 private:
  void onMap(const octomap_msgs::Octomap& message);
  std::optional<soft_tissue::Pose> frameOf(const octomap_msgs::Octomap& message,
                                           std::string& reason) const;
  void reject(std::atomic<std::uint64_t>& count, const std::string& reason);

  soft_tissue::ObstacleConfig config_;
  const tf2_ros::Buffer& buffer_;
  std::string world_frame_;
  double wait_s_;
  Sink sink_;
  double last_warning_s_ = -1.0;  ///< steady clock
  std::atomic<std::uint64_t> accepted_{0}, bad_maps_{0}, without_transform_{0};
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

}  // namespace soft_tissue_sim
