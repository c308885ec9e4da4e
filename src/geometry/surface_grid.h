#pragma once

#include <string>

#include "soft_tissue_sim/geometry/rigid_shape.h"

namespace soft_tissue
{
/** @throws Error unless the value is finite and > 0 (or >= 0), naming `what` */
void requirePositive(double value, const std::string& what);
void requireNotNegative(double value, const std::string& what);

/**
 * How many pieces of at most `max_edge` a length needs, at least `least`.
 * @throws Error unless max_edge > 0
 */
int pieceCount(double length, double max_edge, int least);

/** @throws Error if a surface would take more than four million triangles */
void requireAffordable(double triangle_count, double max_edge);

/** Length of the longest triangle edge, m. */
double longestEdge(const SurfaceMesh& mesh);

/** Each triangle cut into n^2 similar ones, nodes on shared edges shared. */
SurfaceMesh subdivide(const SurfaceMesh& mesh, int n);

/** Edges longer than max_edge halved, in all triangles around them, until none is left. */
SurfaceMesh splitLongEdges(SurfaceMesh mesh, double max_edge);

}  // namespace soft_tissue
