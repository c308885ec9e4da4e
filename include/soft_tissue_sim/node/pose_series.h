#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue_sim
{
/** A tool's recorded poses over time. */
struct PoseSeries
{
  std::vector<double> times_s;  ///< ascending; equal ones allowed, the last of them counts
  std::vector<soft_tissue::Pose> poses_W;

  bool empty() const { return times_s.empty(); }

  /** Pose at a time: linear (slerp) between samples, held before the first and after the last. */
  soft_tissue::Pose at(double time_s) const;
};

}  // namespace soft_tissue_sim
