#include "soft_tissue_sim/scene/pose_config.h"

namespace soft_tissue
{
Pose PoseConfig::toPose() const
{
  Pose pose = Pose::Identity();
  pose.linear() = (Eigen::AngleAxisd(rotation_rpy_rad.z(), Vec3::UnitZ()) *
                   Eigen::AngleAxisd(rotation_rpy_rad.y(), Vec3::UnitY()) *
                   Eigen::AngleAxisd(rotation_rpy_rad.x(), Vec3::UnitX()))
                      .toRotationMatrix();
  pose.translation() = position_m;
  return pose;
}

}  // namespace soft_tissue
