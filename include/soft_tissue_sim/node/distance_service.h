#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <soft_tissue_sim/QueryDistance.h>

#include <mutex>
#include <string>
#include <vector>

#include "soft_tissue_sim/field/deformed_distance.h"
#include "soft_tissue_sim/node/bounded_allocator.h"
#include "soft_tissue_sim/node/frame_publisher.h"
#include "soft_tissue_sim/node/scene_topics.h"

namespace soft_tissue_sim
{
/** `query_distance`: depths at any points, from finished frames, in a thread of its own. */
class DistanceService
{
 public:
  DistanceService(const ros::NodeHandle& node, const SceneInfo& info, std::string world_frame);

  /** Takes a frame that later questions are about. */
  void note(const Frame& frame);

  using Request = QueryDistanceRequest_<BoundedAllocator<void>>;

  /** Answers a question. Always true: what went wrong is in the response. */
  bool query(Request& request, QueryDistance::Response& response);

 private:
  struct Moment
  {
    std::vector<soft_tissue::Points> positions;  ///< per tissue
    ros::Time stamp;
    std::uint64_t step = 0;
    std::uint64_t state_hash = 0;
    bool known = false;
  };

  void takeNewest();
  void answer(const soft_tissue::Vec3& p, const std::vector<std::size_t>& tissues,
              double max_distance, QueryDistance::Response& response) const;

  const SceneInfo& info_;
  std::string world_frame_;
  std::vector<soft_tissue::DeformedDistance> bodies_;  ///< as at asked_
  std::mutex mutex_;
  Moment newest_;  ///< guarded by mutex_
  Moment asked_;
  ros::CallbackQueue queue_;  ///< its own: a long question holds no command up
  ros::NodeHandle node_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace soft_tissue_sim
