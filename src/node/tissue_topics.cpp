#include "soft_tissue_sim/node/tissue_topics.h"

namespace soft_tissue_sim
{
TissueTopics::TissueTopics(ros::NodeHandle& node, const SceneInfo& info, std::size_t tissue,
                           TissueDepths& depths, const std::string& world_frame,
                           const ros::SubscriberStatusCallback& on_subscriber)
    : info_(info), depths_(depths), tissue_(tissue), world_frame_(world_frame)
{
  const std::string& name = info.tissue_names[tissue];
  mesh_ = node.advertise<TissueMesh>(name + "/mesh", 1, true);
  state_ = node.advertise<TissueState>(name + "/state", 1, on_subscriber);
  if (depths.has(tissue))
  {
    field_ = node.advertise<TissueField>(name + "/field", 1, on_subscriber);
  }
  mesh_.publish(meshMessage(info, tissue, {ros::Time::now(), world_frame}));
}

void TissueTopics::publishState(const Frame& frame) const
{
  if (state_.getNumSubscribers() > 0)
  {
    state_.publish(stateMessage(info_, frame.snapshot, tissue_, {frame.stamp, world_frame_}));
  }
}

void TissueTopics::publishField(const Frame& frame) const
{
  if (field_ && field_.getNumSubscribers() > 0)
  {
    field_.publish(fieldMessage(info_, tissue_, frame.snapshot.report.step,
                                depths_.depth(tissue_, frame.snapshot),
                                {frame.stamp, world_frame_}));
  }
}

}  // namespace soft_tissue_sim
