#pragma once

#include <interactive_markers/interactive_marker_server.h>

#include <cstdint>
#include <memory>
#include <string>

#include "soft_tissue_sim/node/physics_loop.h"
#include "soft_tissue_sim/node/tool_inputs.h"

namespace soft_tissue_sim
{
/** Takes a tool's poses from an interactive marker at its frame, with handles to push and turn it
 * along and about each axis. */
class MarkerInput
{
 public:
  /**
   * @param server  of all markers; must outlive this
   * @param tool    name of the tool, and of its marker
   * @param size_m  of the tool: the handles are a little larger
   */
  MarkerInput(interactive_markers::InteractiveMarkerServer& server, const std::string& tool,
              PoseGate& gate, const FrameLookup& frames, const soft_tissue::Pose& X_WT,
              double size_m);

  /** Tries again what waits for its transform. */
  void poll() { poses_.poll(); }

  /** Puts the marker where the tool is, if the world was reset since. */
  void follow(const soft_tissue::Pose& X_WT, std::uint64_t resets);

 private:
  void onFeedback(const visualization_msgs::InteractiveMarkerFeedback::ConstPtr& feedback);

  interactive_markers::InteractiveMarkerServer& server_;
  std::string tool_;
  PoseInput poses_;
  std::uint64_t resets_ = 0;
};

}  // namespace soft_tissue_sim
