#pragma once

#include <optional>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Barycentric coordinates of a tetrahedron as linear functions of position. */
struct TetCoordinates
{
  Vec3 centre;                            ///< mean of the corners, m
  Eigen::Matrix<double, 3, 4> gradients;  ///< column i: gradient of corner i's weight, 1/m

  /** The four weights of a point, sum 1; all >= 0 inside. */
  Eigen::Vector4d weights(const Vec3& p) const
  {
    return (gradients.transpose() * (p - centre)).array() + 0.25;
  }
};

/**
 * The coordinates of the tet with these corners, of either handedness.
 *
 * @return nothing for a tet too flat to have them: six times its volume is not above 1e-12 of the
 *         cube of its longest edge, or a corner isn't finite
 */
std::optional<TetCoordinates> tetCoordinates(const Vec3& a, const Vec3& b, const Vec3& c,
                                             const Vec3& d);

}  // namespace soft_tissue
