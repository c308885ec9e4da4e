#pragma once

#include <cstddef>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/**
 * Turns triangles so that neighbours agree, and closed shells so that they point out of the solid.
 * @return how many triangles were turned
 */
std::size_t orientSurface(TriMesh& mesh);

}  // namespace soft_tissue
