#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <soft_tissue_sim/Attach.h>
#include <soft_tissue_sim/Detach.h>

#include <optional>
#include <string>
#include <vector>

#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/scene_info.h"

namespace soft_tissue_sim
{
/** `<tool>/attach` and `<tool>/detach`, answered one after the other, between two steps. */
class AttachServices
{
 public:
  /** @param info  of the loop's scene; must outlive this */
  AttachServices(const ros::NodeHandle& node, const SceneInfo& info, PhysicsLoop& loop);

  void attach(std::size_t tool, const Attach::Request& request, Attach::Response& response);
  void detach(std::size_t tool, const Detach::Request& request, Detach::Response& response);

 private:
  std::optional<std::size_t> partOf(std::size_t tool, const std::string& name) const;
  std::optional<std::size_t> tissueOf(const std::string& name) const;

  const SceneInfo& info_;
  PhysicsLoop& loop_;
  ros::CallbackQueue queue_;  ///< its own: they wait for a step
  ros::NodeHandle node_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace soft_tissue_sim
