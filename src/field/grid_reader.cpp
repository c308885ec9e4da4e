#include "grid_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace soft_tissue
{
namespace
{
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
}  // namespace

GridReader::GridReader(const GridSpec& grid, const std::vector<double>& depth)
    : grid_(grid),
      depth_(depth),
      dimension_(grid.count[2] > 1 ? 3 : 2),
      stride_{1, grid.count[0], grid.count[0] * grid.count[1]}
{}

double GridReader::interpolate(const Vec3& p) const
{
  double sum = 0.0;
  bool inside = false;
  forCorners(p, [&](Index point, double weight) {
    inside = true;
    sum += weight > 0.0 ? weight * depth_[point] : 0.0;
  });
  return inside ? sum : kNone;
}

double GridReader::extrapolate(const Vec3& p) const
{
  double least = kNone;
  forCorners(p, [&](Index point, double /*weight*/) {
    const Vec3 way = p - grid_.point(point);
    const Vec3 slope = slopeAt(point);
    const double steepest = slope.norm();
    const double there = depth_[point] + (steepest > 0.0 ? slope.dot(way) / steepest : way.norm());
    least = there < least || std::isnan(least) ? there : least;
  });
  return least;
}

/** Calls visit(point, weight) for the corners of p's cell; for none outside the grid. */
template <typename Visit>
void GridReader::forCorners(const Vec3& p, const Visit& visit) const
{
  Index corner = 0;
  double part[3] = {};
  for (int axis = 0; axis < dimension_; ++axis)
  {
    const double place = (p[axis] - grid_.origin[axis]) / grid_.spacing[axis];
    if (!(place >= 0.0 && place <= grid_.count[axis] - 1))
    {
      return;
    }
    const int cell = std::min(static_cast<int>(place), grid_.count[axis] - 2);
    part[axis] = place - cell;
    corner += cell * stride_[axis];
  }
  for (int k = 0; k < (1 << dimension_); ++k)
  {
    double weight = 1.0;
    Index point = corner;
    for (int axis = 0; axis < dimension_; ++axis)
    {
      const bool upper = (k >> axis & 1) != 0;
      weight *= upper ? part[axis] : 1.0 - part[axis];
      point += upper ? stride_[axis] : 0;
    }
    visit(point, weight);
  }
}

/** Differences to the lower neighbour along each axis: the way depth grows. */
Vec3 GridReader::slopeAt(Index point) const
{
  Vec3 slope = Vec3::Zero();
  for (int axis = 0; axis < dimension_; ++axis)
  {
    const Index place = point / stride_[axis] % grid_.count[axis];
    double fall = 0.0;
    for (const int way : {-1, 1})
    {
      const Index other = place + way;
      if (other >= 0 && other < grid_.count[axis])
      {
        const double here = depth_[point] - depth_[point + way * stride_[axis]];
        if (here > fall)
        {
          fall = here;
          slope[axis] = -way * here / grid_.spacing[axis];
        }
      }
    }
  }
  return slope;
}

}  // namespace soft_tissue
