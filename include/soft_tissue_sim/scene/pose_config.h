#pragma once

#include <string>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
struct PoseConfig
{
  Vec3 position_m = Vec3::Zero();
  Vec3 rotation_rpy_rad = Vec3::Zero();  ///< fixed-axis roll, pitch, yaw as in URDF

  Pose toPose() const;
};

struct MeshConfig
{
  std::string file;  ///< absolute path, package:// and relative names already resolved
  double metres_per_unit = 1.0;
};

struct PoseKeyframe
{
  double time_s = 0.0;
  PoseConfig pose;
};

}  // namespace soft_tissue
