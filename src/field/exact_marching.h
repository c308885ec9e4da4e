#pragma once

#include "soft_tissue_sim/field/distance_field.h"
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
class ExactMarching : public DistanceField
{
 public:
  explicit ExactMarching(const FieldTopology& topology);

  void march(const Points& x) override;
  void marchUntil(const Points& x, const std::vector<Index>& wanted) override;
  const std::vector<double>& depth() const override { return depth_; }
  const std::vector<Index>& closestTriangle() const override { return closest_; }
  std::uint64_t evaluations() const override { return evaluations_; }

 private:
  void begin(const Points& x);
  void makeOrder(const Points& x);
  int visit(Index node, Index chunk_begin, const Points& x);

  FieldTopology topology_;
  TriangleTree tree_;
  std::vector<Index> order_;  ///< inner nodes
  std::vector<Index> rank_;   ///< per node: place in order_; -1 on the boundary
  std::vector<double> depth_;
  std::vector<Index> closest_;
  std::vector<Index> hint_;     ///< per node: the triangle nearest to it when last marched, or -1
  std::vector<Index> touched_;  ///< inner nodes with a depth
  std::uint64_t evaluations_ = 0;
};

}  // namespace soft_tissue
