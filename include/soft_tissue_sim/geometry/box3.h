#pragma once

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Axis-aligned box, metres; empty while min > max. */
struct Box3
{
  Vec3 min = Vec3::Constant(1e300);
  Vec3 max = Vec3::Constant(-1e300);

  void extend(const Vec3& p)
  {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  void extend(const Box3& other)
  {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  void grow(double margin)
  {
    min.array() -= margin;
    max.array() += margin;
  }
  bool overlaps(const Box3& other) const
  {
    return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
  }
  bool contains(const Vec3& p) const
  {
    return (min.array() <= p.array()).all() && (p.array() <= max.array()).all();
  }
  /** Square of the distance from a point to the box, m^2; 0 inside. */
  double squaredDistance(const Vec3& p) const
  {
    return (min - p).cwiseMax(p - max).cwiseMax(0.0).squaredNorm();
  }
};

inline Box3 boundsOf(const Points& points)
{
  Box3 box;
  for (const Vec3& p : points)
  {
    box.extend(p);
  }
  return box;
}

/** Of some of them, by number. */
inline Box3 boundsOf(const Points& points, const std::vector<Index>& which)
{
  Box3 box;
  for (const Index i : which)
  {
    box.extend(points[i]);
  }
  return box;
}

/** The box around a moved one, which is then no longer along the axes. */
inline Box3 transformed(const Pose& X, const Box3& box)
{
  const Vec3 centre = X * Vec3(0.5 * (box.min + box.max));
  const Vec3 half = X.linear().cwiseAbs() * (0.5 * (box.max - box.min));
  Box3 result;
  result.min = centre - half;
  result.max = centre + half;
  return result;
}

}  // namespace soft_tissue
