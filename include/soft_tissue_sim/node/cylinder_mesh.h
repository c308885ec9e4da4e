#pragma once

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue_sim
{
/**
 * Closed triangle mesh of a cylinder along z, centred at the origin.
 *
 * A prism of 24 sides whose corners lie on the cylinder: its flats lie at most 0.9 % of the radius
 * inside. Its quads are about as long as wide up to a factor of two, so that contact is felt
 * everywhere on it.
 * @param radius  m, > 0
 * @param length  m, > 0
 */
soft_tissue::TriMesh cylinderMesh(double radius, double length);

}  // namespace soft_tissue_sim
