#include "soft_tissue_sim/node/octomap_topics.h"

#include <utility>

#include "soft_tissue_sim/scene/octomap_data.h"

namespace soft_tissue_sim
{
OctomapTopics::OctomapTopics(ros::NodeHandle& node, const soft_tissue::SceneConfig& config,
                             const SceneInfo& info, std::string world_frame,
                             const ros::SubscriberStatusCallback& on_subscriber)
    : cells_(config, info.tissues),
      world_frame_(std::move(world_frame)),
      full_(node.advertise<octomap_msgs::Octomap>("octomap_full", 1, on_subscriber)),
      binary_(node.advertise<octomap_msgs::Octomap>("octomap_binary", 1, on_subscriber))
{}

void OctomapTopics::publish(const Frame& frame)
{
  if (full_.getNumSubscribers() == 0 && binary_.getNumSubscribers() == 0)
  {
    return;
  }
  cells_.update(frame.snapshot);
  ++maps_built_;
  publish(full_, false, frame.stamp);
  publish(binary_, true, frame.stamp);
}

void OctomapTopics::publish(const ros::Publisher& publisher, bool binary,
                            const ros::Time& stamp) const
{
  if (publisher.getNumSubscribers() == 0)
  {
    return;
  }
  const soft_tissue::OctomapData map =
      soft_tissue::octomapOf(cells_.occupied(), cells_.seen(), binary);
  octomap_msgs::Octomap message;
  message.header.frame_id = world_frame_;
  message.header.stamp = stamp;
  message.binary = map.binary;
  message.id = map.id;
  message.resolution = map.resolution;
  message.data.assign(map.bytes.begin(), map.bytes.end());
  publisher.publish(message);
}

}  // namespace soft_tissue_sim
