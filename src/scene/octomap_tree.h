#pragma once

#include <cstdint>
#include <string>

#include "soft_tissue_sim/geometry/voxel_set.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/** How the nodes of an octree are stored. */
struct OctomapFormat
{
  bool binary = false;      ///< occupied or free (.bt), not how likely (.ot)
  bool colour = false;      ///< nodes have a colour as well
  double resolution = 0.0;  ///< edge length of the finest cells, m
};

/**
 * Walks the tree as a reader would: liboctomap itself trusts its input, and runs on at its end.
 * @return its nodes
 * @throws Error saying what is wrong, for what is truncated or has bytes after its end, too
 */
std::uint64_t countOctomapNodes(const std::string& data, const OctomapFormat& format);

/** The cells of a tree that was counted and has nodes. @throws Error for too many */
VoxelSet octomapTreeCells(const std::string& data, const OctomapFormat& format,
                          const OctomapConfig& config);

}  // namespace soft_tissue
