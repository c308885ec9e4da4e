#pragma once

#include <array>

#include "soft_tissue_sim/geometry/voxel_set.h"

namespace soft_tissue
{
/** Makes all cells occupied that have a part of a tet in their inside. Source: [Gottschalk1996],
 * the theorem of separating axes. */
void coverTet(const std::array<Vec3, 4>& tet, VoxelSet& cells);

/** The same of a triangle; one that lies between cells counts to those above. */
void coverTriangle(const std::array<Vec3, 3>& triangle, VoxelSet& cells);

}  // namespace soft_tissue
