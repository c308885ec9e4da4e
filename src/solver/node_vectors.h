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
  if (points.empty())
  {
    return 0.0;
  }
  return Eigen::Map<const Eigen::ArrayXd>(points.data()->data(), 3 * points.size())
      .abs()
      .maxCoeff<Eigen::PropagateNaN>();
}

}  // namespace soft_tissue
