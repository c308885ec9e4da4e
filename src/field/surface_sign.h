#pragma once

#include "soft_tissue_sim/geometry/closest_point.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/**
 * On which side of a closed surface points are, by normals of its faces, edges and nodes.
 *
 * Source: [Baerentzen2005] angle-weighted pseudonormals; in the plane, where faces are edges, the
 * mean of two is enough.
 */
class SurfaceSign
{
 public:
  /** @param surface  outward; triangles, or edges in the plane z = 0  @param x  N x 3, m */
  SurfaceSign(const BoundarySurface& surface, const Points& x);

  /** Whether p is inside, given the nearest point of the surface and the triangle it is on. */
  bool inside(const Vec3& p, Index triangle, const TrianglePoint& nearest) const;

  /** Outward normal of the face, edge or node that the weights tell of; not of unit length. */
  Vec3 normal(Index triangle, const Vec3& weights) const;

 private:
  const BoundarySurface& surface_;
  Points faces_, nodes_;
};

}  // namespace soft_tissue
