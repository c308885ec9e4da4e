#pragma once

#include <cmath>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
constexpr Index kNodeGrain = 512;  ///< nodes per parallel piece

inline double dot(const Points& a, const Points& b)
{
  return parallelSum(static_cast<Index>(a.size()), kNodeGrain, [&](Index begin, Index end) {
    double sum = 0.0;
    for (Index i = begin; i < end; ++i)
    {
      sum += a[i].dot(b[i]);
    }
    return sum;
  });
}

/** Largest coordinate in size; NaN where one is. */
inline double largest(const Points& points)
{
  double size = 0.0;
  for (const Vec3& p : points)
  {
    const double here = p.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    size = here > size || std::isnan(here) ? here : size;
  }
  return size;
}

}  // namespace soft_tissue
