#pragma once

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/collision/box_ends.h"
#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
/** Least and greatest coordinates of some nodes, and of their moves, m. */
struct NodeExtremes
{
  Vec3 low, high;
  Vec3 least_move, most_move;
  bool finite = true;  ///< all coordinates are; otherwise the rest says nothing
};

/** A pair whose boxes may overlap, and where among some boxes that of its first element is. */
struct BoxedPair
{
  ElementPair pair;
  Index box;
};

/** Loops over nodes and boxes; all sets of instructions give the same bits. */
struct BoxKernels
{
  /** Of `count` nodes, ascending, from where they were before, one after the other; nullptr: no
   * moves. */
  NodeExtremes (*extremes)(const Vec3* x, const Index* nodes, const Vec3* before, Index count);
  /** Boxes of some elements of a first set, grown by a margin. All nodes are finite. m */
  void (*boxes)(const ElementSet& set, const Vec3* x, double margin, const Index* elements,
                Index count, BoxEnds* boxes);
  /** Copies those of the pairs whose boxes overlap; those of a second element follow each other.
   * @param boxes  of first elements
   * @param set    the second elements; all nodes are finite
   * @param near   out, room for all
   * @return how many */
  Index (*pick)(const BoxedPair* pairs, Index count, const BoxEnds* boxes, const ElementSet& set,
                const Vec3* x, ElementPair* near);
};

/** The loops for this machine. */
const BoxKernels& boxKernels(InstructionSet set);

}  // namespace soft_tissue
