#pragma once

#include <optional>

#include "soft_tissue_sim/geometry/barycentric.h"

namespace soft_tissue
{
/** The piece of a segment a-b inside a tet: from a + lambda1 (b - a) to a + lambda2 (b - a). */
struct ClippedSegment
{
  double lambda1 = 0.0;      ///< in [0, lambda2]
  double lambda2 = 1.0;      ///< in [lambda1, 1]
  Eigen::Vector4d weights1;  ///< barycentric weights of the first end
  Eigen::Vector4d weights2;  ///< barycentric weights of the second end
};

/**
 * Clips segment a-b against a closed tet.
 *
 * The only tolerance is 1e-12 in the dimensionless weights, so units don't matter. Touching counts:
 * a corner or edge hit gives a piece of length zero, and a segment in a face belongs to the tets on
 * both its sides.
 * Source: [Marchal2004] segment-in-object response.
 * @return nothing where they don't meet
 */
std::optional<ClippedSegment> clipSegment(const Vec3& a, const Vec3& b, const TetCoordinates& tet);

}  // namespace soft_tissue
