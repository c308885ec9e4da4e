#pragma once

#include "closed_surface.h"
#include "soft_tissue_sim/geometry/aabb_tree.h"
#include "soft_tissue_sim/geometry/closest_point.h"

namespace soft_tissue
{
/**
 * Distances to a triangle mesh, with a sign.
 *
 * Source: [Baerentzen2005] sign of the distance by angle-weighted pseudonormals.
 */
class SignedSurface
{
 public:
  /** @param on_surface  distance below which a point's direction to the mesh is lost, in the
   * diagonal of the mesh's bounds */
  void build(SurfaceMesh mesh, PseudoNormals normals, double on_surface);

  /** What is farther than another by less than this factor may be as far: rounding decides. */
  static constexpr double kTied = 1.0 + 1e-12;

  struct Nearest
  {
    Index triangle = -1;  ///< none nearer than the bound
    TrianglePoint at;

    /** Nearer, or as near and first in the mesh. */
    bool isBefore(const Nearest& other) const
    {
      return at.squared_distance < other.at.squared_distance ||
             (at.squared_distance == other.at.squared_distance && triangle < other.triangle);
    }
  };

  /** The mesh's point nearest to p, if its squared distance is below the bound, m^2; of triangles
   * as near as each other the first. */
  Nearest nearest(const Vec3& p, double bound = std::numeric_limits<double>::infinity()) const;

  /** Calls visit(Nearest) for triangles whose boxes are no farther than this, m^2, all the nearer
   * triangles among them. */
  template <typename Visit>
  void forEachWithin(const Vec3& p, double squared_distance, const Visit& visit) const
  {
    tree_.forEachWithin(p, squared_distance,
                        [&](Index triangle) { visit(nearestOn(triangle, p)); });
  }

  /** A triangle's point nearest to p. */
  Nearest nearestOn(Index triangle, const Vec3& p) const;

  SignedDistance distance(const Vec3& p, const Nearest& nearest) const;
  /** Second derivative of distance(), 1/m. */
  Mat3 curvature(const Vec3& p, const Nearest& nearest) const;

  Box3 bounds() const { return tree_.bounds(); }
  const SurfaceMesh& mesh() const { return mesh_; }
  const PseudoNormals& normals() const { return normals_; }

 private:
  TrianglePoint closestOn(Index triangle, const Vec3& p) const;
  const Vec3& pseudoNormal(const Nearest& nearest) const;

  SurfaceMesh mesh_;
  PseudoNormals normals_;
  AabbTree tree_;
  double on_surface_ = 0.0;
};

}  // namespace soft_tissue
