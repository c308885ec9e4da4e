#pragma once

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"

namespace soft_tissue
{
/** Largest distance any point has moved, m; infinite when that can't be told. */
double largestMotion(const Points& from, const Points& to);

/** What all points moved by, and how far any has moved beside, where that can't be told infinitely
 * far; nothing from no points. */
NodeMotion motionBetween(const Points& from, const Points& to);

}  // namespace soft_tissue
