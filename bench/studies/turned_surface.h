#pragma once

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::studies
{
/**
 * A surface of triangles that a line in the half plane y = 0, x >= 0 leaves when it is turned about
 * the z axis; outward if the line goes up with the body on its left.
 * @param line    m; ends at x = 0 become poles
 * @param around  nodes on a ring
 * @param closed  the line's last point goes on to its first
 */
TriMesh turnedSurface(const Points& line, int around, bool closed);

}  // namespace soft_tissue::studies
