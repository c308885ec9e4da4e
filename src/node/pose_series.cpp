#include "soft_tissue_sim/node/pose_series.h"

#include <algorithm>

namespace soft_tissue_sim
{
soft_tissue::Pose PoseSeries::at(double time_s) const
{
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  const std::size_t next = static_cast<std::size_t>(after - times_s.begin());
  if (next == 0)
  {
    return poses_W.front();
  }
  if (next == times_s.size())
  {
    return poses_W.back();
  }
  const soft_tissue::Pose& a = poses_W[next - 1];
  const soft_tissue::Pose& b = poses_W[next];
  const double t = (time_s - times_s[next - 1]) / (times_s[next] - times_s[next - 1]);
  const Eigen::Quaterniond qa(a.linear());
  const Eigen::Quaterniond qb(b.linear());
  soft_tissue::Pose between = soft_tissue::Pose::Identity();
  between.linear() = qa.slerp(t, qb).toRotationMatrix();
  between.translation() = (1.0 - t) * a.translation() + t * b.translation();
  return between;
}

}  // namespace soft_tissue_sim
