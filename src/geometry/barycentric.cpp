#include "soft_tissue_sim/geometry/barycentric.h"

#include <algorithm>
#include <cmath>

namespace soft_tissue
{
namespace
{
/** Least 6 V / (longest edge)^3: four digits of the volume are left above rounding. */
constexpr double kFlat = 1e-12;
}  // namespace

std::optional<TetCoordinates> tetCoordinates(const Vec3& a, const Vec3& b, const Vec3& c,
                                             const Vec3& d)
{
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ad = d - a;
  const Vec3 bc = c - b;
  const Vec3 bd = d - b;
  const double volume6 = ab.cross(ac).dot(ad);
  const double longest =
      std::sqrt(std::max({ab.squaredNorm(), ac.squaredNorm(), ad.squaredNorm(), bc.squaredNorm(),
                          bd.squaredNorm(), (d - c).squaredNorm()}));
  if (!(std::abs(volume6) > kFlat * longest * longest * longest) || !std::isfinite(volume6))
  {
    return std::nullopt;
  }
  TetCoordinates result;
  result.centre = 0.25 * (a + b + c + d);
  result.gradients.col(0) = bd.cross(bc) / volume6;
  result.gradients.col(1) = ac.cross(ad) / volume6;
  result.gradients.col(2) = ad.cross(ab) / volume6;
  result.gradients.col(3) = ab.cross(ac) / volume6;
  return result;
}

}  // namespace soft_tissue
