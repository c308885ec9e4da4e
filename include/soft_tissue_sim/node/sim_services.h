#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <soft_tissue_sim/LoadState.h>
#include <soft_tissue_sim/SaveState.h>
#include <soft_tissue_sim/SetMaterial.h>
#include <soft_tissue_sim/Step.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/progress_topic.h"
#include "soft_tissue_sim/node/scene_info.h"

namespace soft_tissue_sim
{
/** Services that act on the physics as a whole: `pause_physics`, `unpause_physics`, `cancel`,
 * `reset_world`, `reset_simulation`, `save_state`, `load_state` and `set_material`, answered one
 * after the other, and `step`, between whose steps they act. */
class SimServices
{
 public:
  /** @param owns_clock  only then time can begin again: there is `reset_simulation` */
  SimServices(const ros::NodeHandle& node, const SceneInfo& info, bool owns_clock,
              PhysicsLoop& loop, ProgressTopic& progress);

 private:
  bool pause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool unpause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool step(Step::Request& request, Step::Response& response);
  bool reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);

  bool resetSimulation(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool save(SaveState::Request& request, SaveState::Response& response);
  bool load(LoadState::Request& request, LoadState::Response& response);
  bool setMaterial(SetMaterial::Request& request, SetMaterial::Response& response);
  bool cancel(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  template <typename Act, typename Response>
  void answer(const char* name, const Act& act, Response& response);

  const SceneInfo& info_;
  PhysicsLoop& loop_;
  ProgressTopic& progress_;
  ros::CallbackQueue step_queue_;  ///< its own: the others can end a long step
  ros::NodeHandle step_node_;
  ros::AsyncSpinner step_spinner_;
  ros::CallbackQueue queue_;  ///< its own: they hold no command up
  ros::NodeHandle node_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace soft_tissue_sim
