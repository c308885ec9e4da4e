#pragma once

#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/collision/interval.h"

namespace soft_tissue
{
/** Signed distance at a point of a segment and its slope along the segment's parameter, both in m.
 */
struct SegmentDistance
{
  double distance = 0.0;
  double slope = 0.0;
};

/** Part of a segment that is inside, and which of its ends are on the surface rather than ends of
 * cells. */
struct InsideInterval
{
  Interval where;
  bool begin_on_surface = false;
  bool end_on_surface = false;
};

namespace detail
{
/** Parameter where the distance is zero between one point inside and one outside (regula falsi,
 * Illinois). */
template <typename Distance>
double surfaceCrossing(const Distance& distance, double inside, double f_inside, double outside,
                       double f_outside)
{
  constexpr int kMaxSteps = 60;
  constexpr double kTolerance = 1e-12;
  double root = inside;
  int last_side = 0;
  for (int step = 0; step < kMaxSteps && std::abs(outside - inside) > kTolerance; ++step)
  {
    root = (inside * f_outside - outside * f_inside) / (f_outside - f_inside);
    const double f = distance(root).distance;
    if (std::abs(f) <= kTolerance * std::abs(f_outside - f_inside))
    {
      break;
    }
    const int side = f < 0.0 ? -1 : 1;
    (side < 0 ? inside : outside) = root;
    (side < 0 ? f_inside : f_outside) = f;
    if (side == last_side)
    {
      (side < 0 ? f_outside : f_inside) *= 0.5;
    }
    last_side = side;
  }
  return root;
}

/** A parameter between two outside ones where the distance is negative, or -1: descent by bisecting
 * the slope. */
template <typename Distance>
double dip(const Distance& distance, double begin, double end)
{
  constexpr int kMaxSteps = 40;
  for (int step = 0; step < kMaxSteps; ++step)
  {
    const double middle = 0.5 * (begin + end);
    const SegmentDistance at = distance(middle);
    if (at.distance < 0.0)
    {
      return middle;
    }
    // Between two kinks or on a convex solid the distance stays above its tangent.
    if (at.distance - std::abs(at.slope) * 0.5 * (end - begin) >= 0.0)
    {
      return -1.0;
    }
    (at.slope < 0.0 ? begin : end) = middle;
  }
  return -1.0;
}
}  // namespace detail

/**
 * Calls visit(interval) for the parts of a segment where a signed distance is negative, cut at
 * fixed cells.
 *
 * Whole cells inside are passed as they are, so quadrature points in them do not move with the
 * solid; cells that cross the surface are cut at it. A dip between two cell ends that are outside
 * is found where the solid is convex within the cell.
 * @param distance  callable: parameter in [0, 1] to SegmentDistance
 * @param length    of the segment, m
 * @param cells     number of equal cells, >= 1
 */
template <typename Distance, typename Visit>
void forEachInsideInterval(const Distance& distance, double length, int cells, const Visit& visit)
{
  if (!(distance(0.5).distance < 0.5 * length))  // no point of it can be inside
  {
    return;
  }
  const double cell_length = length / cells;
  double begin = 0.0;
  SegmentDistance at_begin = distance(0.0);
  for (int cell = 1; cell <= cells; ++cell)
  {
    const double end = static_cast<double>(cell) / cells;
    const SegmentDistance at_end = distance(end);
    const double f0 = at_begin.distance;
    const double f1 = at_end.distance;
    if (f0 < 0.0 && f1 < 0.0)
    {
      visit(InsideInterval{{begin, end}, false, false});
    }
    else if (f0 < 0.0)
    {
      visit(InsideInterval{
          {begin, detail::surfaceCrossing(distance, begin, f0, end, f1)}, false, true});
    }
    else if (f1 < 0.0)
    {
      visit(InsideInterval{
          {detail::surfaceCrossing(distance, end, f1, begin, f0), end}, true, false});
    }
    else if (f0 + f1 < cell_length && at_begin.slope < 0.0 && at_end.slope > 0.0)
    {
      const double bottom = detail::dip(distance, begin, end);
      if (bottom >= 0.0)
      {
        const double f = distance(bottom).distance;
        visit(InsideInterval{{detail::surfaceCrossing(distance, bottom, f, begin, f0),
                              detail::surfaceCrossing(distance, bottom, f, end, f1)},
                             true,
                             true});
      }
    }
    begin = end;
    at_begin = at_end;
  }
}

}  // namespace soft_tissue
