#include "soft_tissue_sim/node/scene_topics.h"

#include <rosgraph_msgs/Clock.h>

namespace soft_tissue_sim
{
SceneTopics::SceneTopics(ros::NodeHandle& node, const SceneInfo& info, TissueDepths& depths,
                         const MarkerOptions& options, bool publish_clock,
                         const std::string& world_frame,
                         const ros::SubscriberStatusCallback& on_subscriber)
    : info_(info), builder_(info, options), depths_(depths), world_frame_(world_frame)
{
  stats_ = node.advertise<SimStats>("stats", 1, on_subscriber);
  markers_ = node.advertise<visualization_msgs::MarkerArray>("markers", 1, on_subscriber);
  if (!info.tissue_pairs.empty())
  {
    contacts_ = node.advertise<TissueContacts>("contacts", 1, on_subscriber);
  }
  if (publish_clock)
  {
    clock_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10, true);
  }
}

void SceneTopics::publishStats(const Frame& frame) const
{
  if (stats_.getNumSubscribers() > 0)
  {
    stats_.publish(
        statsMessage(frame.snapshot, frame.real_time_factor, {frame.stamp, world_frame_}));
  }
}

void SceneTopics::publishMarkers(const Frame& frame)
{
  if (markers_.getNumSubscribers() == 0)
  {
    return;
  }
  const Stamp stamp{frame.stamp, world_frame_};
  visualization_msgs::MarkerArray array = builder_.build(frame.snapshot, depths_, stamp);
  if (frame.resets != last_resets_)
  {
    last_resets_ = frame.resets;
    array.markers.insert(array.markers.begin(), MarkerBuilder::deleteAll(stamp));
  }
  ++marker_arrays_built_;
  markers_.publish(array);
}

void SceneTopics::publishContacts(const Frame& frame) const
{
  if (contacts_ && contacts_.getNumSubscribers() > 0)
  {
    contacts_.publish(tissueContactsMessage(info_, frame.snapshot, {frame.stamp, world_frame_}));
  }
}

void SceneTopics::publishClock(const Frame& frame) const
{
  rosgraph_msgs::Clock message;
  message.clock = frame.stamp;
  clock_.publish(message);
}

}  // namespace soft_tissue_sim
