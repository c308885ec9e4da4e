#pragma once

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/index.h"

namespace soft_tissue
{
/**
 * Four children of an inner node of a TriangleTree, or four triangles of a leaf. Each lies in a box
 * along the axes, and between two planes across a normal of its own: the triangle's, or that of the
 * patch of surface below the child, which is nearly flat where it is small.
 */
struct TriangleTreeNode
{
  alignas(32) double min[3][4];     ///< m; +infinity for a child that isn't there
  alignas(32) double max[3][4];     ///< m; -infinity for a child that isn't there
  alignas(32) double normal[3][4];  ///< unit; zero: there are no planes
  alignas(32) double low[4];        ///< least normal . p of what is in the child, m
  alignas(32) double high[4];       ///< greatest, m
  Index child[4];                   ///< node, or triangle in a leaf; -1: none
  bool leaf;
};

/** Looks closely at a triangle. @return the bound from then on: a squared distance, m^2 */
using VisitTriangle = double (*)(void* context, Index triangle);

/**
 * Visits, from near to far, all triangles that may be nearer to p than the bound, or as near.
 * @param nodes  from the root on
 * @param p      3, m
 * @param slack  rounding of a distance to a plane, m
 * @param bound  squared distance, m^2
 */
using SearchTriangleTree = void (*)(const TriangleTreeNode* nodes, const double* p, double slack,
                                    double bound, VisitTriangle visit, void* context);

/** The search for this machine. */
SearchTriangleTree searchTriangleTree(InstructionSet set);

}  // namespace soft_tissue
