#pragma once

#include <vector>

#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
/**
 * Drops pairs whose tet has a face that parts it from the segment by more than a margin, eight at a
 * time in single precision: clipPairs() finds nothing of them until both together have moved by the
 * margin. Most pairs of a search by boxes are such.
 * @param segments    of one or two nodes each
 * @param x_segments  what they number, m
 * @param tets        of four nodes each
 * @param x_tets      what they number, m
 * @param margin      m, >= 0
 * @param pairs       a segment and a tet each; those left stay in their order
 */
void dropParted(const ElementSet& segments, const Vec3* x_segments, const ElementSet& tets,
                const Vec3* x_tets, double margin, std::vector<ElementPair>& pairs);

}  // namespace soft_tissue
