#pragma once

#include <urdf_model/model.h>

#include <string>
#include <vector>

#include "soft_tissue_sim/scene/tool_config.h"

namespace soft_tissue_sim
{
soft_tissue::PoseConfig poseConfig(const urdf::Pose& pose);

/**
 * The joints between links of a URDF.
 * @param links      names of links that there are
 * @param from_root  all from the root of the URDF; else only what moves them against each other
 * @throws soft_tissue::Error for a joint of another kind, without axis, with limits that exclude
 * each other, or that mimics none that moves
 */
soft_tissue::Linkage urdfLinkage(const urdf::ModelInterface& model,
                                 const std::vector<std::string>& links, bool from_root);

}  // namespace soft_tissue_sim
