#pragma once

#include <functional>
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

/** Two elements whose boxes overlap, those of the first set grown by a margin. */
struct ElementPair
{
  Index first;
  Index second;
};

/** How overlapping boxes are looked for; all find the same. */
enum class PairMethod
{
  tree,   ///< trees of boxes over both sets, gone through together
  hash,   ///< voxels; each element of the second set stands in the one that its middle is in
  sweep,  ///< ends of groups' boxes along an axis, in last time's order, then their elements
};

/** As fast as the sweep where little touches, faster where bodies bend a lot or are large. */
constexpr PairMethod kDefaultPairMethod = PairMethod::tree;

/** Finds the pairs of elements of two sets, or of one body, that may touch. */
class PairFinder
{
 public:
  virtual ~PairFinder() = default;

  /**
   * Finds every pair whose boxes are no farther apart than a margin, along each axis. The first
   * call arranges the elements; what a later one finds depends on its own positions alone.
   * @param x_first   positions that the first set's numbers count in, m
   * @param x_second  those of the second set
   * @param margin    m, >= 0
   * @param pairs     out, ascending by second, then by first; elements with a node that is not
   *                  finite are in none
   */
  virtual void find(const Vec3* x_first, const Vec3* x_second, double margin,
                    std::vector<ElementPair>& pairs) = 0;

  /** Pairs for which never(pair) is true are none; said before the first find(). */
  virtual void leaveOut(std::function<bool(const ElementPair&)> never) = 0;
};

/**
 * @param one_body  both sets number the nodes of the same body: pairs that share a node are no
 *                  pairs
 */
std::unique_ptr<PairFinder> makePairFinder(PairMethod method, const ElementSet& first,
                                           const ElementSet& second, bool one_body);

}  // namespace soft_tissue
