#include "pose_track.h"

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

PoseTrack::PoseTrack(const std::vector<PoseKeyframe>& keyframes)
{
  for (const PoseKeyframe& keyframe : keyframes)
  {
    times_.push_back(keyframe.time_s);
    poses_.push_back(keyframe.pose.toPose());
  }
}

Pose PoseTrack::at(double time_s) const
{
  const auto after = std::upper_bound(times_.begin(), times_.end(), time_s);
  if (after == times_.begin())
  {
    return poses_.front();
  }
  if (after == times_.end())
  {
    return poses_.back();
  }
  const std::size_t k = after - times_.begin();
  return interpolate(poses_[k - 1], poses_[k],
                     (time_s - times_[k - 1]) / (times_[k] - times_[k - 1]));
}

}  // namespace soft_tissue
