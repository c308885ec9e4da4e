#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue::studies
{
/** Whether this was built with CGAL. */
bool haveCgal();

/** Distance of each point to the nearest triangle by CGAL's AABB tree, built for it; what many
 * would take. */
std::vector<double> cgalDistances(const Points& points, const std::vector<Triangle>& triangles,
                                  const Points& x);

}  // namespace soft_tissue::studies
