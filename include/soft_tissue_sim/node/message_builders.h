#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <soft_tissue_sim/SimStats.h>
#include <soft_tissue_sim/TissueContacts.h>
#include <soft_tissue_sim/TissueField.h>
#include <soft_tissue_sim/TissueMesh.h>
#include <soft_tissue_sim/TissueState.h>
#include <soft_tissue_sim/ToolContacts.h>

#include <string>
#include <vector>

#include "soft_tissue_sim/node/scene_info.h"

namespace soft_tissue_sim
{
/** Where and when a message's content holds. */
struct Stamp
{
  ros::Time time;
  std::string world_frame;
};

TissueMesh meshMessage(const SceneInfo& info, std::size_t tissue, const Stamp& stamp);
TissueState stateMessage(const SceneInfo& info, const soft_tissue::Snapshot& snapshot,
                         std::size_t tissue, const Stamp& stamp);
/** @param depth  per node, m */
TissueField fieldMessage(const SceneInfo& info, std::size_t tissue, std::uint64_t step,
                         const std::vector<double>& depth, const Stamp& stamp);
geometry_msgs::PoseStamped toolPoseMessage(const soft_tissue::ToolState& tool, const Stamp& stamp);
/** The joints that move by themselves. */
sensor_msgs::JointState jointMessage(const soft_tissue::ToolInfo& info,
                                     const soft_tissue::ToolState& tool, const Stamp& stamp);
/** Of a tool with a jaw: where that is, by the name "jaw". */
sensor_msgs::JointState jawMessage(const soft_tissue::ToolConfig& config,
                                   const soft_tissue::ToolState& tool, const Stamp& stamp);
/** Force of tissue on the tool, about the tool frame's origin, in tool axes; frame_id is the tool.
 */
geometry_msgs::WrenchStamped bodyWrenchMessage(const soft_tissue::ToolState& tool,
                                               const std::string& tool_name, const Stamp& stamp);
/** Force of tissue on the tool, about the tool frame's origin, in world axes; frame_id is the
 * world. */
geometry_msgs::WrenchStamped spatialWrenchMessage(const soft_tissue::ToolState& tool,
                                                  const Stamp& stamp);
/** What pushes one tool. */
ToolContacts contactsMessage(const SceneInfo& info, const soft_tissue::Snapshot& snapshot,
                             std::size_t tool, const Stamp& stamp);
/** What pushes tissues: the contacts of all pairs. */
TissueContacts tissueContactsMessage(const SceneInfo& info, const soft_tissue::Snapshot& snapshot,
                                     const Stamp& stamp);
SimStats statsMessage(const soft_tissue::Snapshot& snapshot, double real_time_factor,
                      const Stamp& stamp);

}  // namespace soft_tissue_sim
