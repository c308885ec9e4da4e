#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <soft_tissue_sim/Step.h>
#include <std_srvs/Empty.h>

#include "soft_tissue_sim/node/physics_loop.h"

namespace soft_tissue_sim
{
/** `pause_physics`, `unpause_physics`, `step`, `reset_world`, answered one after the other. */
class SimServices
{
 public:
  SimServices(const ros::NodeHandle& node, PhysicsLoop& loop);

 private:
  bool pause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool unpause(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);
  bool step(Step::Request& request, Step::Response& response);
  bool reset(std_srvs::Empty::Request& request, std_srvs::Empty::Response& response);

  PhysicsLoop& loop_;
  ros::CallbackQueue queue_;  ///< its own: a long step holds no command up
  ros::NodeHandle node_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace soft_tissue_sim
