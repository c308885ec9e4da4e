#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "soft_tissue_sim/geometry/box3.h"
#include "soft_tissue_sim/geometry/closest_point.h"
#include "soft_tissue_sim/geometry/shortlist.h"
#include "soft_tissue_sim/geometry/triangle_tree_kernels.h"

namespace soft_tissue
{
/** How nodes moved: all by `shift`, and each by at most `rest` beside, m. */
struct NodeMotion
{
  Vec3 shift = Vec3::Zero();
  double rest = 0.0;
};

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
    TrianglePoint point = {Vec3::Zero(), Vec3::Zero(), std::numeric_limits<double>::infinity()};
    int evaluations = 0;  ///< triangles looked at closely

    /** Takes the nearer one; of equally near ones that of least number. */
    void take(Index other, const TrianglePoint& at)
    {
      if (at.squared_distance < point.squared_distance ||
          (at.squared_distance == point.squared_distance && other < triangle))
      {
        triangle = other;
        point = at;
      }
    }
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
    return nearestOf(p, x, hint, {}, [](Index) { return true; });
  }

  /**
   * The same of those triangles that allowed(triangle) is true for.
   * @param x       where nodes are now, N x 3, m
   * @param motion  of nodes since the last build() or refit()
   */
  template <typename Allowed>
  Nearest nearestOf(const Vec3& p, const Points& x, Index hint, const NodeMotion& motion,
                    const Allowed& allowed) const;

  /**
   * The nearest triangle, and all that are less than `slack` farther, as many as a list holds.
   * While nodes and p together move by less than half of the radius less the distance, the nearest
   * is in the list.
   */
  Nearest shortlist(const Vec3& p, const Points& x, Index hint, const NodeMotion& motion,
                    double slack, Shortlist& list) const
  {
    const auto any = [](Index) { return true; };
    return shortlistOf(p, x, hint, motion, any, any, slack, list);
  }

  /** The nearest of those that are allowed; the list has all that may be listed, which are those
   * and others. */
  template <typename Allowed, typename Listed>
  Nearest shortlistOf(const Vec3& p, const Points& x, Index hint, const NodeMotion& motion,
                      const Allowed& allowed, const Listed& listed, double slack,
                      Shortlist& list) const;

 private:
  struct Reach;
  template <typename Allowed>
  struct Search;
  template <typename Allowed, typename Listed>
  struct ListingSearch;
  template <typename AnySearch>
  void find(const Vec3& in_tree, Index hint, AnySearch& search) const;
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

/** Where a search is, and how far it goes. */
struct TriangleTree::Reach
{
  const Vec3& p;
  const Points& x;
  const std::vector<Triangle>* triangles;  ///< none of an empty tree
  double farther;   ///< than the nearest one so far what is looked at may seem in the tree, m
  Index hint = -1;  ///< looked at already
  Nearest found = Nearest();

  TrianglePoint closest(Index triangle)
  {
    ++found.evaluations;
    const Triangle& t = (*triangles)[triangle];
    return closestOnTriangle(p, x[t[0]], x[t[1]], x[t[2]]);
  }

  /** What the square of another triangle's distance in the tree must not be above. */
  double limit() const
  {
    constexpr double kRounding = 1e-13;  // of squared distances, as a share
    const double squared = found.point.squared_distance;
    const double in_tree = farther > 0.0 ? std::sqrt(squared) + farther : 0.0;
    return (1.0 + kRounding) * (farther > 0.0 ? in_tree * in_tree : squared);
  }
};

template <typename Allowed>
struct TriangleTree::Search : Reach
{
  const Allowed& allowed;

  bool counts(Index triangle) const { return allowed(triangle); }
  void look(Index triangle) { found.take(triangle, closest(triangle)); }
};

template <typename Allowed, typename Listed>
struct TriangleTree::ListingSearch : Reach
{
  const Allowed& allowed;
  const Listed& listed;
  Shortlist& list;

  bool counts(Index triangle) const { return listed(triangle); }
  void look(Index triangle)
  {
    const TrianglePoint point = closest(triangle);
    list.add(triangle, std::sqrt(point.squared_distance));
    if (allowed(triangle))
    {
      found.take(triangle, point);
    }
  }
};

template <typename Allowed>
TriangleTree::Nearest TriangleTree::nearestOf(const Vec3& p, const Points& x, Index hint,
                                              const NodeMotion& motion,
                                              const Allowed& allowed) const
{
  Search<Allowed> search{{p, x, triangles_, motion.rest}, allowed};
  find(p - motion.shift, hint, search);
  return search.found;
}

template <typename Allowed, typename Listed>
TriangleTree::Nearest TriangleTree::shortlistOf(const Vec3& p, const Points& x, Index hint,
                                                const NodeMotion& motion, const Allowed& allowed,
                                                const Listed& listed, double slack,
                                                Shortlist& list) const
{
  list = Shortlist();
  ListingSearch<Allowed, Listed> search{
      {p, x, triangles_, motion.rest + slack}, allowed, listed, list};
  find(p - motion.shift, hint, search);
  list.shrink(std::sqrt(search.found.point.squared_distance) + slack);
  return search.found;
}

template <typename AnySearch>
void TriangleTree::find(const Vec3& in_tree, Index hint, AnySearch& search) const
{
  if (hint >= 0 && search.counts(hint))
  {
    search.look(hint);
    search.hint = hint;
  }
  this->search(
      in_tree, search.limit(),
      [](void* context, Index triangle) {
        AnySearch& one = *static_cast<AnySearch*>(context);
        if (triangle != one.hint && one.counts(triangle))
        {
          one.look(triangle);
        }
        return one.limit();
      },
      &search);
}

}  // namespace soft_tissue
