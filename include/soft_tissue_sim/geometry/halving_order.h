#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Numbers 0 ... N-1 of points in an order that has near ones together: points are halved across
 * where they reach farthest, each half comes as a whole, and is halved in turn. The first half of
 * the order is on one side of the body, so threads that share loops over it in halves have little
 * to tell each other. The points (N x 3, m) must be finite. */
std::vector<Index> halvingOrder(const Points& points);

/** In which of the 2^halvings parts, counted along that order, each point is. */
std::vector<int> halvedParts(const Points& points, int halvings);

}  // namespace soft_tissue
