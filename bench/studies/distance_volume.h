#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue::studies
{
/** Whether this was built with OpenVDB. */
bool haveOpenVdb();

/** Depth of points inside a closed surface as OpenVDB's volume of it has it, made for it on one
 * thread and read linearly. @param voxel  edge length, m */
std::vector<double> openVdbDepths(const Points& points, const std::vector<Triangle>& triangles,
                                  const Points& x, double voxel);

}  // namespace soft_tissue::studies
