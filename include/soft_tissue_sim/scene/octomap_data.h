#pragma once

#include <string>

#include "soft_tissue_sim/geometry/voxel_set.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/** An octree as liboctomap writes it, without the header of a file: what octomap_msgs/Octomap
 * carries. */
struct OctomapData
{
  bool binary = false;      ///< free and occupied alone, not how likely
  std::string id;           ///< class of the tree
  double resolution = 0.0;  ///< edge length of its finest cells, m
  std::string bytes;
};

/**
 * The cells of an octree, metres, in its frame. An octree without nodes says nothing of any.
 * @param config  which of its cells, see OctomapConfig; its resolution is the one of the cells
 * @throws Error for a class or resolution that is not the config's, for what is truncated or
 * damaged, and for more cells than memory should go into
 */
VoxelSet octomapCells(const OctomapData& octomap, const OctomapConfig& config);

/**
 * The same the other way: an OcTree with those cells occupied or free for certain. It has no cells
 * farther from the origin than 32768 of them: those are left out.
 * @param cells     occupied
 * @param known     free where they are not occupied; of all others it says nothing
 */
OctomapData octomapOf(const VoxelSet& cells, const VoxelSet& known, bool binary);

}  // namespace soft_tissue
