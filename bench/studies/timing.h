#pragma once

#include <time.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace soft_tissue::studies
{
/** Time this thread has had, s: without what other programs took from it. */
inline double threadSeconds()
{
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/** The middle one of at least one value; the upper one of two. */
inline double median(std::vector<double> values)
{
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/** Of at least one value. */
inline double mean(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace soft_tissue::studies
