#pragma once

#include "fem_table.h"

namespace soft_tissue::studies
{
/**
 * Cook's membrane at small strain in plane strain, one layer of cells x cells cells, pulled up at
 * its right end: how far (48, 52) goes, per unit force, and the thread's time for Newton's method.
 */
FemResult cookMembrane(const FemChoice& choice, int cells, double poisson_ratio);

}  // namespace soft_tissue::studies
