#pragma once

#include <ros/time.h>

#include <optional>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/series.h"
#include "soft_tissue_sim/node/stream_counts.h"
#include "soft_tissue_sim/node/twist_command.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue_sim
{
/** What a bag tells of one tool; empty where it tells nothing. */
struct BagTool
{
  std::optional<soft_tissue::Pose> first_pose;  ///< X_WT to start at
  soft_tissue::PoseSeries poses;
  TwistSeries twists;
  soft_tissue::JointSeries joints, jaw;  ///< joints that others move are no numbers
  std::vector<StreamCounts> counts;      ///< of all that was read for it
};

/** Tool poses read from a bag, on a clock that starts with the earliest of them. */
struct BagPoses
{
  ros::Time start;             ///< stamp of the earliest pose, velocity or position of a joint
  double length_s = 0.0;       ///< from there to the latest one
  std::vector<BagTool> tools;  ///< one per tool of the scene
  std::vector<std::string> warnings;
};

/**
 * Reads what moves all tools that topics or tf frames move.
 *
 * Poses are those on `.../<tool>/<its topic>` or, if the bag has none, `.../<tool>/measured_cp`,
 * below any namespace; joints those on `.../<tool>/<its joint topic>` and `.../<tool>/<its jaw's>`,
 * or else on `.../<tool>/measured_js` and `.../<tool>/jaw/measured_js`. Samples are sorted by
 * header stamp (by recording time where it is zero). Frames other than the world are resolved
 * through /tf and /tf_static in the bag, where frames that tools and joints follow are read, too. A
 * tool that velocities move starts where `measured_cp` has it when the clock starts, if the bag has
 * that. What the node would reject is left out, with a warning; the inputs are the node's own.
 * @param tools  their URDFs are read
 * @throws soft_tissue::Error if the file is not a readable bag, or has no usable pose (naming the
 * topics it has), or two topics claim the same tool
 */
BagPoses readBagPoses(const std::string& path, const std::vector<soft_tissue::ToolConfig>& tools,
                      const std::string& world_frame);

}  // namespace soft_tissue_sim
