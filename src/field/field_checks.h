#pragma once

#include "soft_tissue_sim/field/distance_field.h"

namespace soft_tissue
{
/** The topology itself. @throws Error if parts of it are missing or don't match */
const FieldTopology& checked(const FieldTopology& topology);

/** @throws Error unless there is a position for each node */
void checkPositions(const Points& x, std::size_t node_count);

/** @throws Error for a node that isn't there */
void checkWanted(const std::vector<Index>& wanted, std::size_t node_count);

}  // namespace soft_tissue
