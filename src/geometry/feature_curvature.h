#pragma once

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * Second derivative of the distance to a point, a line or a plane, 1/m.
 * @param offset    from the nearest point of that feature, m; zero gives zero
 * @param straight  projector on the directions in which the feature extends
 */
inline Mat3 aroundFeature(const Vec3& offset, const Mat3& straight)
{
  const double distance = offset.norm();
  if (!(distance > 0.0))
  {
    return Mat3::Zero();
  }
  const Vec3 normal = offset / distance;
  return (Mat3::Identity() - normal * normal.transpose() - straight) / distance;
}

}  // namespace soft_tissue
