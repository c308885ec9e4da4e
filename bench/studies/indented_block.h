#pragma once

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::studies
{
/** A block on and below z = 0 whose cells, 2 cells x 2 cells x cells, grow about `growth` from the
 * origin outwards like sinh(growth u), u going from 0 to 1; `reach` is half its width, and its
 * depth, in metres. */
TetMesh blockAroundTip(int cells, double growth, double reach);

/** Size of blockAroundEdge's cells at the edge, in its radii over the nodes on a circle. */
constexpr double kEdgeCell = 1.6;

/**
 * A round block on and below z = 0: a square of cells about the z axis in rings of cells, whose
 * nodes lie on circles, one of them of radius `edge_radius`. Cells there are kEdgeCell / around of
 * that radius across it and in depth, and grow away from it by exp(8.5 / around) from one to the
 * next.
 * @param around  nodes on each circle, a multiple of four
 * @param reach   its radius and depth, metres
 */
TetMesh blockAroundEdge(int around, double edge_radius, double reach);

}  // namespace soft_tissue::studies
