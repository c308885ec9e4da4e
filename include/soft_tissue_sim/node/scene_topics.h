#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <cstdint>

#include "soft_tissue_sim/node/markers.h"
#include "soft_tissue_sim/node/physics_loop.h"

namespace soft_tissue_sim
{
/** What concerns the scene as a whole: `stats`, `markers`, if tissues may touch each other
 * `contacts` and, if asked, `/clock`. */
class SceneTopics
{
 public:
  /** @param on_subscriber  called when somebody subscribes */
  SceneTopics(ros::NodeHandle& node, const SceneInfo& info, TissueDepths& depths,
              const MarkerOptions& options, bool publish_clock, const std::string& world_frame,
              const ros::SubscriberStatusCallback& on_subscriber);

  void publishStats(const Frame& frame) const;
  void publishMarkers(const Frame& frame);
  void publishContacts(const Frame& frame) const;
  void publishClock(const Frame& frame) const;

  /** How many marker arrays were built so far: none without a subscriber. */
  std::uint64_t markerArraysBuilt() const { return marker_arrays_built_; }

 private:
  const SceneInfo& info_;
  MarkerBuilder builder_;
  TissueDepths& depths_;
  std::string world_frame_;
  ros::Publisher stats_;
  ros::Publisher markers_;
  ros::Publisher contacts_;
  ros::Publisher clock_;
  std::uint64_t last_resets_ = 0;
  std::atomic<std::uint64_t> marker_arrays_built_{0};
};

}  // namespace soft_tissue_sim
