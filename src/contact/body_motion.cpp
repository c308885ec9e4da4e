#include "body_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace soft_tissue
{
namespace
{
/** Of coordinates: rounding where they are shifted. */
constexpr double kShiftRounding = 1e-14;
}  // namespace

double largestMotion(const Points& from, const Points& to)
{
  double squared = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    const double moved = (to[i] - from[i]).squaredNorm();
    if (!(moved <= squared))
    {
      squared = moved;
    }
    if (std::isnan(squared))
    {
      return std::numeric_limits<double>::infinity();
    }
  }
  return std::sqrt(squared);
}

NodeMotion motionBetween(const Points& from, const Points& to)
{
  NodeMotion motion;
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    motion.shift += to[i] - from[i];
  }
  motion.shift /= static_cast<double>(std::max<std::size_t>(from.size(), 1));
  double squared = 0.0, largest = 0.0;
  bool finite = true;
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    const double off = (to[i] - from[i] - motion.shift).squaredNorm();
    finite = finite && std::isfinite(off);
    squared = std::max(squared, off);
    largest = std::max(largest, from[i].squaredNorm());
  }
  const double shifted = motion.shift == Vec3::Zero()
                             ? 0.0
                             : kShiftRounding * (std::sqrt(largest) + motion.shift.norm());
  motion.rest = finite ? std::sqrt(squared) + shifted : std::numeric_limits<double>::infinity();
  return motion;
}

}  // namespace soft_tissue
