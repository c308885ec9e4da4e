#pragma once

namespace soft_tissue
{
/** Part of a segment: parameters from `begin` to `end`, 0 at the segment's first point, 1 at its
 * last. */
struct Interval
{
  double begin = 0.0;
  double end = 0.0;
};

}  // namespace soft_tissue
