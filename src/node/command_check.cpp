#include "soft_tissue_sim/node/command_check.h"

#include <cmath>

namespace soft_tissue_sim
{
namespace
{
constexpr double kQuaternionTolerance = 1.0e-3;
constexpr double kMaxDistance = 10.0;  // m
}  // namespace

const char* rejectionText(Rejection rejection)
{
  switch (rejection)
  {
    case Rejection::none:
      return "accepted";
    case Rejection::not_finite:
      return "NaN or infinity in it";
    case Rejection::not_unit:
      return "the quaternion's norm differs from 1 by more than 0.001";
    case Rejection::too_far:
      return "the position is more than 10 m from the origin";
    case Rejection::unknown_frame:
      return "tf does not connect the frame to the world";
    case Rejection::no_transform:
      return "tf has no transform at the stamp";
    case Rejection::stamp_went_back:
      return "the stamp is older than the one before";
    case Rejection::no_joint:
      return "it has no position for a joint of the tool";
    case Rejection::other_motion:
      return "a link's frame is not where its joint can have it";
  }
  return "unknown";
}

Rejection checkPose(const geometry_msgs::Pose& pose)
{
  const auto& p = pose.position;
  const auto& q = pose.orientation;
  const double distance = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!std::isfinite(distance) || !std::isfinite(norm))
  {
    return Rejection::not_finite;
  }
  if (std::abs(norm - 1.0) > kQuaternionTolerance)
  {
    return Rejection::not_unit;
  }
  return distance > kMaxDistance ? Rejection::too_far : Rejection::none;
}

}  // namespace soft_tissue_sim
