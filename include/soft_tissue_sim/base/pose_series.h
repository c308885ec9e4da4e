#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Pose between two poses, s in [0, 1]: positions linearly, rotations along the shortest arc. */
Pose interpolate(const Pose& a, const Pose& b, double s);

/** A pose over time. */
struct PoseSeries
{
  std::vector<double> times_s;  ///< ascending; of equal ones the last counts
  std::vector<Pose> poses_W;

  bool empty() const { return times_s.empty(); }

  /** Pose at a time: between samples, or held before the first and after the last. */
  Pose at(double time_s) const;
};

}  // namespace soft_tissue
