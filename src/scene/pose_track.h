#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue
{
/** Pose between two poses, s in [0, 1]: positions linearly, rotations along the shortest arc. */
Pose interpolate(const Pose& a, const Pose& b, double s);

/** A pose over time through key frames, held before the first and after the last. */
class PoseTrack
{
 public:
  /** @param keyframes at least one, times ascending */
  explicit PoseTrack(const std::vector<PoseKeyframe>& keyframes);

  Pose at(double time_s) const;

 private:
  std::vector<double> times_;
  std::vector<Pose, Eigen::aligned_allocator<Pose>> poses_;
};

}  // namespace soft_tissue
