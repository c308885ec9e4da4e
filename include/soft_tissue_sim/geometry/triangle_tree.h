#pragma once

#include <cstdint>
#include <vector>

#include "soft_tissue_sim/geometry/box3.h"
#include "soft_tissue_sim/geometry/closest_point.h"
#include "soft_tissue_sim/geometry/triangle_tree_kernels.h"

namespace soft_tissue
{
/**
 * The triangle of a moving surface nearest to a point: exact, whatever the hint.
 *
 * A tree of four boxes a node, each with a pair of planes along the surface in it. A triangle is
 * looked at closely only if neither its box nor its plane is farther than the nearest one so far:
 * with a good hint almost none is. Queries allocate nothing and may run in several threads.
 */
class TriangleTree
{
 public:
  struct Nearest
  {
    Index triangle = -1;  ///< -1: none is at a finite distance
    TrianglePoint point;
    int evaluations = 0;  ///< triangles looked at closely
  };

  /**
   * Builds the tree over triangles where they are, and keeps a pointer to them.
   * @param x  N x 3, m
   * @throws Error for a triangle that is not finite
   */
  void build(const std::vector<Triangle>& triangles, const Points& x);

  /** Renews boxes and planes after the nodes moved. */
  void refit(const Points& x);

  bool empty() const { return nodes_.empty(); }

  /** Box around all triangles; an empty box without any. */
  Box3 bounds() const;

  /**
   * The nearest triangle to p, of equally near ones that of least number.
   * @param x     as in the last build() or refit()
   * @param hint  a triangle that may be near, or -1
   */
  Nearest nearest(const Vec3& p, const Points& x, Index hint = -1) const;

 private:
  struct Range
  {
    Index begin, end;
  };
  Index buildNode(const std::vector<Vec3>& centres, Index* begin, Index* end);
  Vec3 renewTriangle(TriangleTreeNode& node, int k, const Points& x) const;
  void renewChild(TriangleTreeNode& node, int k, const Points& x) const;

  const std::vector<Triangle>* triangles_ = nullptr;
  SearchTriangleTree search_ = nullptr;
  std::vector<TriangleTreeNode> nodes_;  ///< parents stand before their children
  std::vector<Range> ranges_;            ///< per node: its triangles in order_
  std::vector<Index> order_;             ///< all triangles, those of a node together
  std::vector<Vec3> normals_;            ///< by order_: unit, or zero
  double slack_ = 0.0;                   ///< rounding of a distance to a plane, m
};

}  // namespace soft_tissue
