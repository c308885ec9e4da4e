#include "soft_tissue_sim/geometry/closest_point.h"

#include <limits>

namespace soft_tissue
{
namespace
{
/** Below this squared sine of the corner at a, rounding may put the projection on a wrong side. */
constexpr double kNeedleSquaredSine = 1e-12;

void takeIfNearer(TrianglePoint& best, const SegmentPoint& candidate, int from, int to)
{
  if (candidate.squared_distance < best.squared_distance)
  {
    best.weights.setZero();
    best.weights[from] = 1.0 - candidate.parameter;
    best.weights[to] = candidate.parameter;
    best.point = candidate.point;
    best.squared_distance = candidate.squared_distance;
  }
}
}  // namespace

SegmentPoint closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b)
{
  const Vec3 ab = b - a;
  const double along = ab.dot(p - a);
  const double squared_length = ab.squaredNorm();
  SegmentPoint result;
  if (along <= 0.0 || squared_length == 0.0)
  {
    result.point = a;
  }
  else if (along >= squared_length)
  {
    result.parameter = 1.0;
    result.point = b;
  }
  else
  {
    result.parameter = along / squared_length;
    result.point = a + result.parameter * ab;
  }
  result.squared_distance = (p - result.point).squaredNorm();
  return result;
}

TrianglePoint closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const double ab_ab = ab.squaredNorm();
  const double ac_ac = ac.squaredNorm();
  const double squared_area = ab.cross(ac).squaredNorm();  // of the parallelogram

  TrianglePoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  bool outside_ab = true;
  bool outside_bc = true;
  bool outside_ca = true;
  if (squared_area > 0.0)
  {
    const double ab_ac = ab.dot(ac);
    const double ab_ap = ab.dot(ap);
    const double ac_ap = ac.dot(ap);
    const double v = (ac_ac * ab_ap - ab_ac * ac_ap) / squared_area;
    const double w = (ab_ab * ac_ap - ab_ac * ab_ap) / squared_area;
    const double u = 1.0 - v - w;
    if (u >= 0.0 && v >= 0.0 && w >= 0.0)
    {
      best.weights = Vec3(u, v, w);
      best.point = a + v * ab + w * ac;
      best.squared_distance = (p - best.point).squaredNorm();
    }
    // The nearest point of a convex polygon lies on an edge that has p on its outer side.
    const bool needle = squared_area <= kNeedleSquaredSine * ab_ab * ac_ac;
    outside_ab = needle || w < 0.0;
    outside_bc = needle || u < 0.0;
    outside_ca = needle || v < 0.0;
  }
  if (outside_ab)
  {
    takeIfNearer(best, closestOnSegment(p, a, b), 0, 1);
  }
  if (outside_bc)
  {
    takeIfNearer(best, closestOnSegment(p, b, c), 1, 2);
  }
  if (outside_ca)
  {
    takeIfNearer(best, closestOnSegment(p, c, a), 2, 0);
  }
  return best;
}

}  // namespace soft_tissue
