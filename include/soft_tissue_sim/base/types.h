#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "soft_tissue_sim/base/index.h"

namespace soft_tissue
{
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/** Rigid transform X_AB: maps coordinates in frame B to coordinates in frame A. */
using Pose = Eigen::Isometry3d;

/** N points, each 3 x 1, in metres. */
using Points = std::vector<Vec3>;

/** Four node indices; (x1-x0, x2-x0, x3-x0) is right handed in a valid rest state. */
using Tet = std::array<Index, 4>;

/** Three node indices, counter-clockwise seen from outside. */
using Triangle = std::array<Index, 3>;

/** Two node indices. */
using Edge = std::array<Index, 2>;

}  // namespace soft_tissue
