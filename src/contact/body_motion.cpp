#include "body_motion.h"

#include <cmath>
#include <limits>

namespace soft_tissue
{
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

}  // namespace soft_tissue
