/** The search of a TriangleTree; compiled once per instruction set into SOFT_TISSUE_KERNELS. */
#pragma once

#include <cstring>

#include "soft_tissue_sim/geometry/triangle_tree_kernels.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
typedef double Four __attribute__((vector_size(32)));

inline Four loadFour(const double* p)
{
  Four v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}

inline Four larger(const Four& a, const Four& b)
{
  return a > b ? a : b;
}

/** Squared distances from p to the four boxes. */
inline Four boxBounds(const TriangleTreeNode& node, const double* p)
{
  Four sum = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const Four below = loadFour(node.min[axis]) - p[axis];
    const Four above = p[axis] - loadFour(node.max[axis]);
    const Four outside = larger(larger(below, above), Four{});
    sum += outside * outside;
  }
  return sum;
}

/** At most the squared distances from p to what is between the four pairs of planes. */
inline Four planeBounds(const TriangleTreeNode& node, const double* p, double slack)
{
  const Four height = loadFour(node.normal[0]) * p[0] + loadFour(node.normal[1]) * p[1] +
                      loadFour(node.normal[2]) * p[2];
  const Four outside = larger(loadFour(node.low) - height, height - loadFour(node.high));
  const Four away = larger(outside - slack, Four{});
  return away * away;
}

inline void searchTree(const TriangleTreeNode* nodes, const double* p, double slack, double bound,
                       VisitTriangle visit, void* context)
{
  struct Entry
  {
    double bound;
    Index node;
  };
  // At most three more than it takes off with each level; four children a level: 2^31 nodes are 16
  // levels.
  Entry stack[64];
  int size = 0;
  stack[size++] = {0.0, 0};
  while (size > 0)
  {
    const Entry top = stack[--size];
    if (top.bound > bound)
    {
      continue;
    }
    const TriangleTreeNode& node = nodes[top.node];
    const Four bounds = larger(boxBounds(node, p), planeBounds(node, p, slack));
    if (node.leaf)
    {
      for (int k = 0; k < 4; ++k)
      {
        if (bounds[k] <= bound && node.child[k] >= 0)
        {
          bound = visit(context, node.child[k]);
        }
      }
      continue;
    }
    const int first = size;
    for (int k = 0; k < 4; ++k)
    {
      if (bounds[k] <= bound && node.child[k] >= 0)
      {
        // The nearest goes on top.
        int place = size++;
        for (; place > first && stack[place - 1].bound < bounds[k]; --place)
        {
          stack[place] = stack[place - 1];
        }
        stack[place] = {bounds[k], node.child[k]};
      }
    }
  }
}

SearchTriangleTree treeSearch()
{
  return searchTree;
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
