#pragma once

#include <cmath>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Calls f(i) for all of `count` nodes. */
template <typename Function>
void forNodes(std::size_t count, const Function& f)
{
  parallelForEach(0, static_cast<Index>(count), kNodeGrain, f);
}

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
