#include "soft_tissue_sim/base/pose_series.h"

#include <algorithm>

namespace soft_tissue
{
Pose interpolate(const Pose& a, const Pose& b, double s)
{
  if (s <= 0.0)
  {
    return a;
  }
  if (s >= 1.0)
  {
    return b;
  }
  Pose pose = Pose::Identity();
  const Eigen::Quaterniond qa(a.linear()), qb(b.linear());
  pose.linear() = qa.slerp(s, qb).toRotationMatrix();
  pose.translation() = (1.0 - s) * a.translation() + s * b.translation();
  return pose;
}

Pose PoseSeries::at(double time_s) const
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
  return interpolate(poses_W[next - 1], poses_W[next],
                     (time_s - times_s[next - 1]) / (times_s[next] - times_s[next - 1]));
}

}  // namespace soft_tissue
