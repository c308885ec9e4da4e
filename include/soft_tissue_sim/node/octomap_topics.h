#pragma once

#include <octomap_msgs/Octomap.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <cstdint>
#include <string>

#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/scene_info.h"
#include "soft_tissue_sim/scene/tissue_cells.h"

namespace soft_tissue_sim
{
/** `octomap_full` and `octomap_binary`: where the tissues are, and where they were. */
class OctomapTopics
{
 public:
  /**
   * @param on_subscriber  called when somebody subscribes
   * @throws soft_tissue::Error for cells that are too small
   */
  OctomapTopics(ros::NodeHandle& node, const soft_tissue::SceneConfig& config,
                const SceneInfo& info, std::string world_frame,
                const ros::SubscriberStatusCallback& on_subscriber);

  void publish(const Frame& frame);

  /** How often cells were found so far: never without a subscriber. */
  std::uint64_t mapsBuilt() const { return maps_built_; }

 private:
  void publish(const ros::Publisher& publisher, bool binary, const ros::Time& stamp) const;

  soft_tissue::TissueCells cells_;
  std::string world_frame_;
  ros::Publisher full_, binary_;
  std::atomic<std::uint64_t> maps_built_{0};
};

}  // namespace soft_tissue_sim
