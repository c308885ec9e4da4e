#pragma once

#include <vector>

#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/** How strongly a node is held: the size of its block on the diagonal, N/m. */
double holdOf(const BlockMatrix& a, Index row);

/**
 * Nodes that blocks of A's pattern couple to others, which the fixed ones are not: body by body,
 * and in parts where some of it is much stiffer than the rest. That moves like a rigid body, and
 * neighbours would hardly move it.
 */
std::vector<std::vector<Index>> stiffAndSoftParts(const BlockMatrix& a);

}  // namespace soft_tissue
