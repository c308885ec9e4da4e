#pragma once

#include "nodal_field.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"

namespace soft_tissue
{
/**
 * Exact depths, at marching cost: nodes are taken along a space-filling curve, the triangle nearest
 * to a neighbour before them is the hint of a search that finds the nearest of all.
 *
 * A march that wants some nodes only looks at those. The first march takes memory, and needs a
 * boundary that is finite.
 */
class ExactMarching : public NodalField
{
 public:
  explicit ExactMarching(const FieldTopology& topology);

  void march(const Points& x) override;
  void marchUntil(const Points& x, const std::vector<Index>& wanted) override;
  void exchange(StateArchive& archive) override;

 private:
  void begin(const Points& x);
  void makeOrder(const Points& x);
  int visit(Index node, Index chunk_begin, const Points& x);

  TriangleTree tree_;
  Points built_at_;           ///< where nodes were when the tree and the order were made
  std::vector<Index> order_;  ///< inner nodes
  std::vector<Index> rank_;   ///< per node: place in order_; -1 on the boundary
  std::vector<Index> hint_;   ///< per node: the triangle nearest to it when last marched, or -1
};

}  // namespace soft_tissue
