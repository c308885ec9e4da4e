#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/transform_broadcaster.h>

#include "soft_tissue_sim/node/message_builders.h"
#include "soft_tissue_sim/node/physics_loop.h"

namespace soft_tissue_sim
{
/** `<tool>/measured_cp`, `<tool>/{body,spatial}/measured_cf`, `<tool>/contacts`, the tool's tf
 * frame, and `<tool>/measured_js` and `<tool>/jaw/measured_js` if it has joints and a jaw. */
class ToolTopics
{
 public:
  /** @param on_subscriber  called when somebody subscribes */
  ToolTopics(ros::NodeHandle& node, const SceneInfo& info, std::size_t tool,
             const std::string& world_frame, const ros::SubscriberStatusCallback& on_subscriber);

  void publish(const Frame& frame);

 private:
  void broadcastFrame(const soft_tissue::ToolState& tool, const ros::Time& stamp);

  const SceneInfo& info_;
  std::size_t tool_;
  std::string world_frame_;
  ros::Publisher pose_;
  ros::Publisher body_wrench_;
  ros::Publisher spatial_wrench_;
  ros::Publisher contacts_;
  ros::Publisher joints_;  ///< none of a tool without
  ros::Publisher jaw_;     ///< none of a tool without
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Time last_broadcast_;
};

}  // namespace soft_tissue_sim
