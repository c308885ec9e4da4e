#pragma once

#include <vector>

#include "soft_tissue_sim/collision/interval.h"
#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
/** The part of a segment that lies in a tet, of more than no length; of a point in a tet all. */
struct ClippedPair
{
  ElementPair pair;  ///< the segment, or point, and the tet
  Interval where;
};

/**
 * Clips segments against tets, or tells which points are in them: clipSegment() four at a time.
 * Flat tets hold nothing.
 * @param segments    of one or two nodes each
 * @param x_segments  what they number, m
 * @param tets        of four nodes each
 * @param x_tets      what they number, m
 * @param pairs       a segment and a tet each
 * @param pieces      out, in the pairs' order
 */
void clipPairs(const ElementSet& segments, const Vec3* x_segments, const ElementSet& tets,
               const Vec3* x_tets, const std::vector<ElementPair>& pairs,
               std::vector<ClippedPair>& pieces);

}  // namespace soft_tissue
