#include "soft_tissue_sim/node/transform_check.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>

namespace soft_tissue_sim
{
namespace
{
/** Stamps after this second, in the year 2038, overflow where tf takes others from them. */
constexpr std::uint32_t kLastSecond = std::numeric_limits<std::int32_t>::max() - 3600;
}  // namespace

std::string transformRefusal(const geometry_msgs::TransformStamped& transform)
{
  const auto& t = transform.transform.translation;
  const auto& r = transform.transform.rotation;
  const Eigen::Quaterniond rotation(r.w, r.x, r.y, r.z);
  constexpr double kUnit = 0.01;  // as tf has it
  return transform.header.frame_id.empty() || transform.child_frame_id.empty()
             ? "a frame has no name"
         : transform.header.frame_id == transform.child_frame_id ? "a frame in itself"
         : !std::isfinite(t.x + t.y + t.z)                       ? "not finite"
         : !(std::abs(rotation.squaredNorm() - 1.0) <= kUnit)    ? "quaternion not unit"
         : transform.header.stamp.sec > kLastSecond ? "its stamp is beyond the end of time"
                                                    : "";
}

}  // namespace soft_tissue_sim
