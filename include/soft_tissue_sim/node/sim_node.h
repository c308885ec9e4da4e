#pragma once

#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <deque>
#include <memory>

#include "soft_tissue_sim/node/attach_services.h"
#include "soft_tissue_sim/node/diagnostics.h"
#include "soft_tissue_sim/node/distance_service.h"
#include "soft_tissue_sim/node/frame_publisher.h"
#include "soft_tissue_sim/node/inputs.h"
#include "soft_tissue_sim/node/node_params.h"
#include "soft_tissue_sim/node/octomap_topics.h"
#include "soft_tissue_sim/node/progress_topic.h"
#include "soft_tissue_sim/node/sim_services.h"
#include "soft_tissue_sim/node/tissue_topics.h"
#include "soft_tissue_sim/node/tool_topics.h"

namespace soft_tissue_sim
{
/** The simulation as a ROS node: inputs, the physics loop, outputs, services, diagnostics. */
class SimNode
{
 public:
  /**
   * @param node  handle whose namespace all topics, services and parameters are in
   * @param progress  must outlive it
   * @throws soft_tissue::Error if the scene and the parameters can't be used together
   */
  SimNode(const ros::NodeHandle& node, const NodeParams& params, soft_tissue::Scene scene,
          ProgressTopic& progress);
  ~SimNode();

  /** Whether the physics had to end for an exception. */
  bool failed() const { return failed_; }

 private:
  void addOutputs();
  void addSlowOutputs();
  void onFailure(const std::string& what);

  ros::NodeHandle node_;
  NodeParams params_;
  SceneInfo info_;
  const soft_tissue::SceneConfig config_;
  std::atomic<bool> failed_{false};
  PhysicsLoop loop_;

  std::unique_ptr<Inputs> inputs_;

  FramePublisher publisher_;  ///< of what is small and waited for
  LatestExchange<Frame> slow_frames_;
  FramePublisher slow_publisher_;  ///< of what takes longer to make
  TissueDepths depths_;            ///< used by its thread only, once it runs
  std::unique_ptr<SceneTopics> scene_topics_;
  std::unique_ptr<OctomapTopics> octomap_topics_;
  std::deque<TissueTopics> tissue_topics_;
  std::deque<ToolTopics> tool_topics_;
  std::unique_ptr<Diagnostics> diagnostics_;
  ros::WallTimer diagnostics_timer_;
  std::unique_ptr<DistanceService> distances_;
  std::unique_ptr<SimServices> services_;
  std::unique_ptr<AttachServices> attach_services_;
};

}  // namespace soft_tissue_sim
