#pragma once

#include <visualization_msgs/Marker.h>

#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** A marker of what one link of a tool looks like, without pose and stamp. */
struct ToolLook
{
  visualization_msgs::Marker marker;
  std::size_t link = 0;
  soft_tissue::Pose X_LM = soft_tissue::Pose::Identity();  ///< of the marker on the link
};

/** What a tool looks like: the visuals of its URDF, and the surface of those parts that have none.
 */
std::vector<ToolLook> toolLooks(const soft_tissue::ToolInfo& tool,
                                const soft_tissue::ToolConfig& config);

}  // namespace soft_tissue_sim
