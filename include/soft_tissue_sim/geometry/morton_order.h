#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Numbers 0 ... N-1 of points along a Morton curve: those near in the order are near in space. The
 * points (N x 3, m) must be finite. */
std::vector<Index> mortonOrder(const Points& points);

}  // namespace soft_tissue
