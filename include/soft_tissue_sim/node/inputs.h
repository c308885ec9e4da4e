#pragma once

#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <tf2_ros/buffer.h>

#include <deque>
#include <memory>
#include <vector>

#include "soft_tissue_sim/node/joint_inputs.h"
#include "soft_tissue_sim/node/map_input.h"
#include "soft_tissue_sim/node/marker_input.h"
#include "soft_tissue_sim/node/node_params.h"
#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/scene_info.h"
#include "soft_tissue_sim/node/tf_listener.h"

namespace soft_tissue_sim
{
/** All that comes from outside: maps of obstacles, and what moves tools, as the scene names it: one
 * source for each tool's pose, one for its joints and one for its jaw. */
class Inputs
{
 public:
  /**
   * @param info       of the loop's scene; must outlive this
   * @param obstacles  the scene's: the maps of some come on topics
   * @throws soft_tissue::Error for a tool that follows its own or another tool's frame
   */
  Inputs(const ros::NodeHandle& node, const NodeParams& params, const SceneInfo& info,
         const std::vector<soft_tissue::ObstacleConfig>& obstacles, PhysicsLoop& loop);
  ~Inputs();

  /** What becomes of each stream of commands. */
  std::vector<const CommandWatch*> watches() const;
  const std::deque<MapInput>& maps() const { return maps_; }

  /** Notes a finished step. */
  void note(const Frame& frame);

 private:
  void addPose(std::size_t tool, PhysicsLoop& loop);
  void addTf(std::size_t tool, PoseGate& gate);
  void addMarker(std::size_t tool, PoseGate& gate);
  void addJoints(std::size_t tool, PhysicsLoop& loop);
  void poll();

  ros::NodeHandle node_;
  const SceneInfo& info_;
  tf2_ros::Buffer buffer_;
  TfListener listener_;
  FrameLookup frames_;
  double watchdog_s_;
  std::unique_ptr<interactive_markers::InteractiveMarkerServer> marker_server_;
  std::deque<PoseGate> pose_gates_;
  std::deque<TwistGate> twist_gates_;
  std::deque<JointGate> joint_gates_;
  std::deque<PoseInput> poses_;
  std::deque<TwistInput> twists_;
  std::deque<TfInput> frames_followed_;
  std::deque<std::pair<std::size_t, MarkerInput>> markers_;  ///< with their tools
  std::deque<JointInput> joints_;
  std::deque<JawInput> jaws_;
  std::deque<JointTfInput> joint_frames_;
  std::deque<MapInput> maps_;
  ros::WallTimer timer_;
};

}  // namespace soft_tissue_sim
