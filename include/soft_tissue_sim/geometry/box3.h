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

}  // namespace soft_tissue
