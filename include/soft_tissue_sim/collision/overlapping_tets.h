#pragma once

#include <vector>

#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
/**
 * Lists the pairs of tets that overlap, as tetsOverlap() says of each: eight at a time in single
 * precision, one by one where that can't tell.
 * @param first       tets of one body, at x_first, m
 * @param second      those of the other, or of the same, at x_second, m
 * @param candidates  pairs to look at; slowest where tets touch without overlapping
 * @param pairs       out, in the order of the candidates
 */
void findOverlappingTets(const ElementSet& first, const Vec3* x_first, const ElementSet& second,
                         const Vec3* x_second, const std::vector<ElementPair>& candidates,
                         std::vector<ElementPair>& pairs);

}  // namespace soft_tissue
