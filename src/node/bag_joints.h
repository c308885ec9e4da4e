#pragma once

#include <rosbag/bag.h>

#include <string>
#include <vector>

#include "soft_tissue_sim/base/series.h"
#include "soft_tissue_sim/scene/tool_config.h"

namespace soft_tissue_sim
{
/** Values of joints at times. */
struct JointSamples
{
  std::vector<ros::Time> stamps;  ///< ascending
  std::vector<soft_tissue::JointValues> values;

  bool empty() const { return stamps.empty(); }
  soft_tissue::JointSeries since(const ros::Time& start) const;
};

/**
 * Reads a topic of sensor_msgs/JointState as JointInput does, or as JawInput, by header stamps (by
 * recording time where they are zero).
 * @param warnings  gets one if messages are left out
 */
JointSamples readJoints(const rosbag::Bag& bag, const std::string& topic,
                        const soft_tissue::ToolConfig& tool, bool of_jaw,
                        std::vector<std::string>& warnings);

}  // namespace soft_tissue_sim
