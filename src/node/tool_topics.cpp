#include "soft_tissue_sim/node/tool_topics.h"

#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
ToolTopics::ToolTopics(ros::NodeHandle& node, const SceneInfo& info, std::size_t tool,
                       const std::string& world_frame,
                       const ros::SubscriberStatusCallback& on_subscriber)
    : info_(info), tool_(tool), world_frame_(world_frame)
{
  const std::string& name = info.tools[tool].name;
  pose_ = node.advertise<geometry_msgs::PoseStamped>(name + "/measured_cp", 1, on_subscriber);
  body_wrench_ =
      node.advertise<geometry_msgs::WrenchStamped>(name + "/body/measured_cf", 1, on_subscriber);
  spatial_wrench_ =
      node.advertise<geometry_msgs::WrenchStamped>(name + "/spatial/measured_cf", 1, on_subscriber);
  contacts_ = node.advertise<ToolContacts>(name + "/contacts", 1, on_subscriber);
  if (!info.tools[tool].joints.empty())
  {
    joints_ = node.advertise<sensor_msgs::JointState>(name + "/measured_js", 1, on_subscriber);
  }
  if (info.tool_configs[tool].jaw)
  {
    jaw_ = node.advertise<sensor_msgs::JointState>(name + "/jaw/measured_js", 1, on_subscriber);
  }
}

void ToolTopics::publish(const Frame& frame)
{
  const soft_tissue::ToolState& tool = frame.snapshot.tools[tool_];
  const Stamp stamp{frame.stamp, world_frame_};
  broadcastFrame(tool, frame.stamp);
  if (pose_.getNumSubscribers() > 0)
  {
    pose_.publish(toolPoseMessage(tool, stamp));
  }
  if (body_wrench_.getNumSubscribers() > 0)
  {
    body_wrench_.publish(bodyWrenchMessage(tool, info_.tools[tool_].name, stamp));
  }
  if (spatial_wrench_.getNumSubscribers() > 0)
  {
    spatial_wrench_.publish(spatialWrenchMessage(tool, stamp));
  }
  if (contacts_.getNumSubscribers() > 0)
  {
    contacts_.publish(contactsMessage(info_, frame.snapshot, tool_, stamp));
  }
  if (joints_ && joints_.getNumSubscribers() > 0)
  {
    joints_.publish(jointMessage(info_.tools[tool_], tool, stamp));
  }
  if (jaw_ && jaw_.getNumSubscribers() > 0)
  {
    jaw_.publish(jawMessage(info_.tool_configs[tool_], tool, stamp));
  }
}

void ToolTopics::broadcastFrame(const soft_tissue::ToolState& tool, const ros::Time& stamp)
{
  if (stamp == last_broadcast_)
  {
    return;  // tf warns of transforms that come twice
  }
  last_broadcast_ = stamp;
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = world_frame_;
  message.child_frame_id = info_.tools[tool_].name;
  message.transform = transformMessage(tool.X_WT);
  broadcaster_.sendTransform(message);
}

}  // namespace soft_tissue_sim
