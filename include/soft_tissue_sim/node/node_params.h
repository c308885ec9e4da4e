#pragma once

#include <ros/node_handle.h>

#include <string>

#include "soft_tissue_sim/node/markers.h"
#include "soft_tissue_sim/node/physics_loop.h"

namespace soft_tissue_sim
{
/** Most messages a second of each kind; 0: one for every step the publishing thread sees. */
struct RateLimits
{
  double state_hz = 30.0;
  double field_hz = 5.0;
  double tool_hz = 0.0;
  double stats_hz = 10.0;
  double marker_hz = 20.0;
};

/** All parameters of the node; defaults stand here only. */
struct NodeParams
{
  std::string scene;  ///< path of the scene file
  int threads = 0;    ///< threads a step may use; 0: one per processor
  std::string world_frame = "world";
  bool publish_clock = false;
  double command_wait_s = 0.2;  ///< how long a command waits for the transform at its stamp
  double tf_poll_hz = 200.0;    ///< how often followed tf frames are looked up
  RateLimits rates;
  MarkerOptions markers;
  PhysicsLoop::Config loop;
};

/**
 * Reads the node's private parameters.
 * @throws soft_tissue::Error naming parameter, value and allowed range
 */
NodeParams readNodeParams(const ros::NodeHandle& private_node);

}  // namespace soft_tissue_sim
