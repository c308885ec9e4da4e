#pragma once

#include <cmath>
#include <limits>
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
  Nearest nearest(const Vec3& p, const Points& x, Index hint = -1) const
  {
    return nearestOf(p, x, hint, 0.0, [](Index) { return true; });
  }

  /**
   * The same of those triangles that allowed(triangle) is true for.
   * @param moved  how far nodes are at most from where the last build() or refit() had them, m
   */
  template <typename Allowed>
  Nearest nearestOf(const Vec3& p, const Points& x, Index hint, double moved,
                    const Allowed& allowed) const;

 private:
  template <typename Allowed>
  struct Search;
  void search(const Vec3& p, double bound, VisitTriangle visit, void* context) const;
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

template <typename Allowed>
struct TriangleTree::Search
{
  const Vec3& p;
  const Points& x;
  const std::vector<Triangle>& triangles;
  double moved;
  const Allowed& allowed;
  Nearest found;

  double visit(Index triangle)
  {
    if (triangle == found.triangle || !allowed(triangle))
    {
      return limit();
    }
    ++found.evaluations;
    const Triangle& t = triangles[triangle];
    const TrianglePoint point = closestOnTriangle(p, x[t[0]], x[t[1]], x[t[2]]);
    if (point.squared_distance < found.point.squared_distance ||
        (point.squared_distance == found.point.squared_distance && triangle < found.triangle))
    {
      found.point = point;
      found.triangle = triangle;
    }
    return limit();
  }

  /** What the square of another triangle's distance in the tree must not be above. */
  double limit() const
  {
    constexpr double kRounding = 1e-13;  // of squared distances, as a share
    const double squared = found.point.squared_distance;
    const double in_tree = moved > 0.0 ? std::sqrt(squared) + moved : 0.0;
    return (1.0 + kRounding) * (moved > 0.0 ? in_tree * in_tree : squared);
  }
};

template <typename Allowed>
TriangleTree::Nearest TriangleTree::nearestOf(const Vec3& p, const Points& x, Index hint,
                                              double moved, const Allowed& allowed) const
{
  Search<Allowed> search{p, x, *triangles_, moved, allowed, {}};
  search.found.point.squared_distance = std::numeric_limits<double>::infinity();
  if (hint >= 0)
  {
    search.visit(hint);
  }
  this->search(
      p, search.limit(),
      [](void* context, Index triangle) {
        return static_cast<Search<Allowed>*>(context)->visit(triangle);
      },
      &search);
  return search.found;
}

}  // namespace soft_tissue
