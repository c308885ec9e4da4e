#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "soft_tissue_sim/node/message_builders.h"
#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/tissue_depths.h"

namespace soft_tissue_sim
{
/** `<tissue>/mesh` (latched), `<tissue>/state` and, if anything can touch the tissue,
 * `<tissue>/field`. */
class TissueTopics
{
 public:
  /** @param on_subscriber  called when somebody subscribes to a state or field */
  TissueTopics(ros::NodeHandle& node, const SceneInfo& info, std::size_t tissue,
               TissueDepths& depths, const std::string& world_frame,
               const ros::SubscriberStatusCallback& on_subscriber);

  void publishState(const Frame& frame) const;
  void publishField(const Frame& frame) const;

 private:
  const SceneInfo& info_;
  TissueDepths& depths_;
  std::size_t tissue_;
  std::string world_frame_;
  ros::Publisher mesh_;
  ros::Publisher state_;
  ros::Publisher field_;
};

}  // namespace soft_tissue_sim
