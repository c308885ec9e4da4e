#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/geometry/box3.h"

namespace soft_tissue
{
/** Elements of one kind, each by the numbers of its nodes: nodes, edges, triangles or tets. Points
 * to what someone else keeps. */
struct ElementSet
{
  const Index* nodes = nullptr;  ///< nodes_each of element 0, of element 1, ...
  int nodes_each = 0;            ///< 1 to 4
  Index count = 0;
};

/** Two elements whose boxes overlap. */
struct ElementPair
{
  Index first;
  Index second;
};

/** How overlapping boxes are looked for; all find the same. */
enum class PairMethod
{
  tree,   ///< trees of boxes over both sets, refitted as they are gone through
  hash,   ///< voxels that the second set's bounding spheres stand in
  sweep,  ///< sorted ends of boxes of groups, then of elements; last time's order is the start
};

/** Finds the pairs of elements of two sets, or of one body, that may touch. */
class PairFinder
{
 public:
  virtual ~PairFinder() = default;

  /**
   * Finds every pair whose boxes are no farther apart than a margin, along each axis.
   * @param x_first   positions that the first set's numbers count in, m
   * @param x_second  those of the second set
   * @param margin    m, >= 0
   * @param pairs     out, ascending by second, then by first; elements with a node that is not
   *                  finite are in none
   */
  virtual void find(const Vec3* x_first, const Vec3* x_second, double margin,
                    std::vector<ElementPair>& pairs) = 0;
};

/**
 * @param one_body  both sets number the nodes of the same body: pairs that share a node are no
 *                  pairs
 */
std::unique_ptr<PairFinder> makePairFinder(PairMethod method, const ElementSet& first,
                                           const ElementSet& second, bool one_body);

}  // namespace soft_tissue
