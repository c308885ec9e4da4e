#pragma once

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Largest distance any point has moved, m; infinite when that can't be told. */
double largestMotion(const Points& from, const Points& to);

}  // namespace soft_tissue
