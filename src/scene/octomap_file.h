#pragma once

#include <string>

#include "soft_tissue_sim/geometry/voxel_set.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/**
 * The cells of an OctoMap file, .bt or .ot, metres, map frame.
 * @param where  "<scene file>: obstacles[0].octomap", for messages
 * @throws Error for a file that is none, or damaged, or has nothing to collide with, or more cells
 * than memory should go into
 */
VoxelSet readOctomap(const OctomapConfig& config, const std::string& where);

}  // namespace soft_tissue
