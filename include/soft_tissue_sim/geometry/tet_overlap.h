#pragma once

#include <array>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * Whether two closed tets have a point in common.
 *
 * Corners in m, in any order; tets may be flat, lines or points. Touching counts: they are apart
 * only if some axis has a gap above 1e-12 of the largest coordinate as seen from the first tet's
 * first corner. Tets with a corner that is not finite overlap nothing.
 * Source: [Gottschalk1996] separating axes: normals of faces, products of edges; for two flat ones
 * also the normals of edges in their plane.
 */
bool tetsOverlap(const std::array<Vec3, 4>& a, const std::array<Vec3, 4>& b);

}  // namespace soft_tissue
