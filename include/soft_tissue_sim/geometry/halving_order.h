#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * Sorts some points' numbers into parts of nearly the same size: cuts across where the points reach
 * farthest, and both sides again.
 * @param parts  at least 1
 * @param visit  visit(begin, end, part) is called part by part, in order; parts of fewer points
 * than there are parts may be left out
 * @param first  number of the first part
 */
template <typename Visit>
void halve(const Points& points, std::vector<Index>::iterator begin,
           std::vector<Index>::iterator end, Index parts, const Visit& visit, Index first = 0)
{
  if (parts == 1 || end - begin <= 1)
  {
    visit(begin, end, first);
    return;
  }
  Vec3 low = points[*begin], high = low;
  std::for_each(begin, end, [&](Index i) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  });
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const Index left = parts / 2;
  const auto middle = begin + (end - begin) * left / parts;
  std::nth_element(begin, middle, end, [&](Index i, Index j) {
    return points[i][axis] != points[j][axis] ? points[i][axis] < points[j][axis] : i < j;
  });
  halve(points, begin, middle, left, visit, first);
  halve(points, middle, end, parts - left, visit, first + left);
}

/** Numbers 0 ... N-1 of points in an order that has near ones together: points are halved across
 * where they reach farthest, each half comes as a whole, and is halved in turn. The first half of
 * the order is on one side of the body, so threads that share loops over it in halves have little
 * to tell each other. The points (N x 3, m) must be finite. */
std::vector<Index> halvingOrder(const Points& points);

/** In which of the 2^halvings parts, counted along that order, each point is. */
std::vector<int> halvedParts(const Points& points, int halvings);

}  // namespace soft_tissue
