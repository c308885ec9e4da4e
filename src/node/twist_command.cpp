#include "soft_tissue_sim/node/twist_command.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace soft_tissue_sim
{
using soft_tissue::Mat3;
using soft_tissue::Pose;
using soft_tissue::Vec3;

Pose moved(const Pose& X_WT, const Twist& twist, double duration_s)
{
  const Mat3 R_WA = twist.in_own_axes ? Mat3(X_WT.linear()) : Mat3::Identity();
  const Vec3 turn = duration_s * (R_WA * twist.angular);
  Pose X = X_WT;
  X.translation() += duration_s * (R_WA * twist.linear);
  if (turn.norm() > 0.0)
  {
    // Through a unit quaternion, so that many small turns leave it a rotation.
    const Eigen::Quaterniond by(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    X.linear() = (by * Eigen::Quaterniond(X_WT.linear())).normalized().toRotationMatrix();
  }
  return X;
}

Pose movedAlong(const Pose& X_WT, const TwistSeries& commands, double begin_s, double end_s,
                double hold_s)
{
  const std::vector<double>& times_s = commands.times_s;
  Pose X = X_WT;
  const auto after = std::upper_bound(times_s.begin(), times_s.end(), begin_s);
  std::size_t k = static_cast<std::size_t>(after - times_s.begin());
  k -= k > 0 ? 1 : 0;  // the one that counts already
  for (; k < times_s.size() && times_s[k] < end_s; ++k)
  {
    const double next_s = k + 1 < times_s.size() ? times_s[k + 1] : end_s;
    const double from_s = std::max(begin_s, times_s[k]);
    const double until_s = std::min({end_s, next_s, times_s[k] + hold_s});
    if (until_s > from_s)
    {
      X = moved(X, commands.samples[k], until_s - from_s);
    }
  }
  return X;
}

void TwistCommand::put(const Twist& twist, double arrival_s)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  twist_ = twist;
  arrival_s_ = arrival_s;
}

std::optional<Twist> TwistCommand::at(double now_s, double hold_s)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (twist_ && (now_s > arrival_s_ + hold_s || now_s < arrival_s_))
  {
    twist_.reset();
  }
  return twist_;
}

void TwistCommand::clear()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  twist_.reset();
}

}  // namespace soft_tissue_sim
