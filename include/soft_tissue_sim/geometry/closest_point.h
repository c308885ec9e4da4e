#pragma once

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Point of a segment a-b nearest to some point. */
struct SegmentPoint
{
  double parameter = 0.0;         ///< in [0, 1]; 0 at a, 1 at b
  Vec3 point = Vec3::Zero();      ///< m
  double squared_distance = 0.0;  ///< m^2
};

/** Nearest point of segment a-b to p; a segment of length zero is its end a. */
SegmentPoint closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b);

/** Point of a triangle nearest to some point. */
struct TrianglePoint
{
  Vec3 weights = Vec3::Zero();    ///< of the three corners, >= 0, sum 1; exactly 0 off the feature
  Vec3 point = Vec3::Zero();      ///< m
  double squared_distance = 0.0;  ///< m^2
};

/**
 * Nearest point of triangle abc to p.
 *
 * Needles, collinear corners and single points are treated as the union of their edges, so the
 * result lies on the triangle and is finite whatever the triangle's shape.
 */
TrianglePoint closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace soft_tissue
