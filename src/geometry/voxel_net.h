#pragma once

#include "closed_surface.h"
#include "soft_tissue_sim/geometry/voxel_set.h"

namespace soft_tissue
{
/** Part of a smoothed boundary of occupied cells, m, with normals as if the rest were there. */
struct VoxelNet
{
  SurfaceMesh mesh;
  PseudoNormals normals;
};

/**
 * The faces of the occupied cells of a box towards free cells, two triangles each, their corners
 * moved to the mean of the faces around them, a few times over, but no farther than a part of a
 * cell: what is flat stays as it is, stairs turn into slopes, and a wall of one cell stays a wall.
 * A face and its normals have the same bits in whatever box they are asked for.
 *
 * Source: [Gibson1998] constrained elastic surface nets.
 */
VoxelNet voxelNet(const VoxelSet& cells, const CellBox& box);

/** Faces that are so many cells apart don't depend on each other's cells. */
int voxelNetReach();

}  // namespace soft_tissue
