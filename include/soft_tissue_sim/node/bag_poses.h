#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

#include "soft_tissue_sim/base/series.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue_sim
{
/** Tool poses read from a bag, on a clock that starts with the earliest of them. */
struct BagPoses
{
  ros::Time start;        ///< stamp of the earliest pose
  double length_s = 0.0;  ///< from the earliest to the latest pose
  std::vector<soft_tissue::PoseSeries>
      tools;  ///< one per tool of the scene, empty where the bag has none
  /** The same of their joints and jaws; joints that others move are no numbers. */
  std::vector<soft_tissue::JointSeries> joints, jaws;
  std::vector<std::string> warnings;
};

/**
 * Reads the poses of all tools that a topic or a tf frame moves.
 *
 * For a topic tool that is `.../<tool>/<its topic>` or, if the bag has none,
 * `.../<tool>/measured_cp`, below any namespace; samples are sorted by header stamp (by recording
 * time where it is zero). Frames other than the world are resolved through /tf and /tf_static in
 * the bag. Joints are those on `.../<tool>/<its joint topic>` and `.../<tool>/<its jaw's>`, or else
 * on
 * `.../<tool>/measured_js` and `.../<tool>/jaw/measured_js`. What the node would reject is left
 * out, with a warning.
 * @param tools  their URDFs are read
 * @throws soft_tissue::Error if the file is not a readable bag, or has no usable pose (naming the
 * topics it has), or two topics claim the same tool
 */
BagPoses readBagPoses(const std::string& path, const std::vector<soft_tissue::ToolConfig>& tools,
                      const std::string& world_frame);

}  // namespace soft_tissue_sim
