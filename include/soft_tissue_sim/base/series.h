#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** The most values that the joints of one tool may have. */
constexpr int kMostJoints = 32;

/** What joints are at: radians where they turn, metres where they slide. Takes no memory from the
 * heap. */
using JointValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostJoints, 1>;

/** Pose between two poses, s in [0, 1]: positions linearly, rotations along the shortest arc. */
Pose interpolate(const Pose& a, const Pose& b, double s);

/** Values between as many others, s in [0, 1], linearly. */
JointValues interpolate(const JointValues& a, const JointValues& b, double s);

/** Something over time. */
template <typename Sample>
struct Series
{
  std::vector<double> times_s;  ///< ascending; of equal ones the last counts
  std::vector<Sample> samples;

  bool empty() const { return times_s.empty(); }

  /** At a time: between samples, or held before the first and after the last. */
  Sample at(double time_s) const
  {
    const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
    const auto next = static_cast<std::size_t>(after - times_s.begin());
    if (next == 0)
    {
      return samples.front();
    }
    if (next == times_s.size())
    {
      return samples.back();
    }
    return interpolate(samples[next - 1], samples[next],
                       (time_s - times_s[next - 1]) / (times_s[next] - times_s[next - 1]));
  }
};

using PoseSeries = Series<Pose>;
using JointSeries = Series<JointValues>;

}  // namespace soft_tissue
