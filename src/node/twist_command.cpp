#include "soft_tissue_sim/node/twist_command.h"

#include <Eigen/Geometry>

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
