#pragma once

#include <array>
#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** Points on the triangles of a surface that is cut finer than its mesh; they move with it. */
struct SurfacePoints
{
  /** A point is the sum of weight times node; where it needs fewer than three, the rest have weight
   * zero. */
  struct Point
  {
    std::array<Index, 3> node{};
    std::array<double, 3> weight{};
  };
  std::vector<Point> points;  ///< the mesh's nodes first, with their numbers
  BoundarySurface surface;    ///< its nodes are points
};

/**
 * Cuts the edges of triangles that are longer at rest, m, again and again in halves; what two
 * triangles share stays shared.
 * @throws Error unless longest_edge > 0
 */
SurfacePoints cutSurface(const TriMesh& rest, double longest_edge);

/** Where the points are when the nodes are at x, m. */
void placePoints(const SurfacePoints& surface, const Points& x, Points& points);

}  // namespace soft_tissue
