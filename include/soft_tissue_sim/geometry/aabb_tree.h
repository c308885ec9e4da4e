#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "soft_tissue_sim/geometry/box3.h"

namespace soft_tissue
{
/**
 * Binary tree of axis-aligned boxes over items numbered 0 ... n-1; one item a leaf, balanced.
 *
 * Queries allocate nothing and may run from several threads at once; refit() keeps the tree's
 * shape.
 */
class AabbTree
{
 public:
  /** Halves the items at the median along the longest axis. @throws Error for a box that is not
   * finite */
  void build(const std::vector<Box3>& boxes);

  /** Renews all boxes after the items moved. @throws Error unless as many boxes as at build */
  void refit(const std::vector<Box3>& boxes);

  bool empty() const { return nodes_.empty(); }

  /** Box around all items; an empty box for an empty tree. */
  Box3 bounds() const { return empty() ? Box3() : nodes_[0].box; }

  /** Calls visit(Index item) for each item whose box touches the given one, in a fixed order. */
  template <typename Visit>
  void query(const Box3& box, Visit&& visit) const
  {
    Stack stack;
    for (Index node = empty() ? -1 : 0; node >= 0;)
    {
      const Node& current = nodes_[node];
      const bool touches = current.box.overlaps(box);
      if (touches && current.item >= 0)
      {
        visit(current.item);
      }
      if (touches && current.item < 0)
      {
        stack.push(current.right);
        node = node + 1;
      }
      else
      {
        node = stack.pop();
      }
    }
  }

  /** Calls visit(Index item) for each item whose box is no farther from p than this, m^2. */
  template <typename Visit>
  void forEachWithin(const Vec3& p, double squared_distance, Visit&& visit) const
  {
    Stack stack;
    for (Index node = empty() ? -1 : 0; node >= 0;)
    {
      const Node& current = nodes_[node];
      const bool near = current.box.squaredDistance(p) <= squared_distance;
      if (near && current.item < 0)
      {
        stack.push(current.right);
        node = node + 1;
        continue;
      }
      if (near)
      {
        visit(current.item);
      }
      node = stack.pop();
    }
  }

  /**
   * The item nearest to a point, where squared_distance(Index item) gives an item's true squared
   * distance (m^2); only those below `bound` count.
   * @return the item, or -1 if none is below the bound
   */
  template <typename SquaredDistance>
  Index closest(const Vec3& p, SquaredDistance&& squared_distance,
                double bound = std::numeric_limits<double>::infinity()) const
  {
    Index best = -1;
    Stack stack;
    for (Index node = empty() ? -1 : 0; node >= 0;)
    {
      const Node& current = nodes_[node];
      if (current.item >= 0)
      {
        const double candidate = squared_distance(current.item);
        if (candidate < bound)
        {
          bound = candidate;
          best = current.item;
        }
        node = stack.popNearer(bound);
        continue;
      }
      Index near_child = node + 1;
      Index far_child = current.right;
      double near_bound = nodes_[near_child].box.squaredDistance(p);
      double far_bound = nodes_[far_child].box.squaredDistance(p);
      if (far_bound < near_bound)
      {
        std::swap(near_child, far_child);
        std::swap(near_bound, far_bound);
      }
      if (far_bound < bound)
      {
        stack.push(far_child, far_bound);
      }
      node = near_bound < bound ? near_child : stack.popNearer(bound);
    }
    return best;
  }

 private:
  struct Node
  {
    Box3 box;
    Index right = -1;  ///< second child; the first follows its parent directly
    Index item = -1;   ///< of a leaf
  };

  /** Nodes still to visit: a balanced tree over 2^31 items is at most 32 deep. */
  struct Stack
  {
    struct Entry
    {
      Index node;
      double lower_bound;
    };
    std::array<Entry, 40> entries;
    int size = 0;

    void push(Index node, double lower_bound = 0.0) { entries[size++] = {node, lower_bound}; }
    Index pop() { return size > 0 ? entries[--size].node : -1; }
    Index popNearer(double bound)
    {
      while (size > 0)
      {
        --size;
        if (entries[size].lower_bound < bound)
        {
          return entries[size].node;
        }
      }
      return -1;
    }
  };

  void buildNode(const std::vector<Box3>& boxes, Index* begin, Index* end);

  std::vector<Node> nodes_;  ///< depth first: parents stand before their children
  std::size_t item_count_ = 0;
};

}  // namespace soft_tissue
