#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/geometry/box3.h"

namespace soft_tissue
{
/** Signed distance to a solid's surface, negative inside, with its gradient. */
struct SignedDistance
{
  double distance = 0.0;        ///< m
  Vec3 normal = Vec3::UnitZ();  ///< unit gradient: points away from the solid
};

/** What of a surface is near a point: for points near that one no search is needed, and the answer
 * is the same. A shape writes it when it had to search. */
struct NearestHint
{
  struct Place
  {
    Index piece, triangle;
    float least;  ///< it is no nearer to the point than this, m
  };
  static constexpr int kMost = 6;

  std::uint64_t surface = 0;  ///< whose it is, and of which version; 0: nobody's
  Vec3 at = Vec3::Zero();     ///< the point, m, shape frame
  double reach = 0.0;         ///< from there: what is nearer is in the list, m
  int count = 0;
  std::array<Place, kMost> near{};  ///< nearest first
};

/** A triangulated surface piece of a solid, for use as contact quadrature and for display. */
struct SurfaceMesh
{
  Points nodes;                     ///< N x 3, m
  std::vector<Triangle> triangles;  ///< outward
};

/** A rigid solid with an exact distance function, in its own frame. Immutable: safe to share. */
class RigidShape
{
 public:
  virtual ~RigidShape() = default;

  /** Exact signed distance of a point, both in the shape frame. */
  virtual SignedDistance distance(const Vec3& p) const = 0;

  /**
   * Second derivative of distance() at a point, shape frame, 1/m: of one side where it jumps, zero
   * where the nearest surface is flat or the direction to it is lost.
   */
  virtual Mat3 curvature(const Vec3& p) const = 0;

  /** The same two, bit by bit, for many points near each other. */
  virtual SignedDistance distance(const Vec3& p, NearestHint& /*hint*/) const
  {
    return distance(p);
  }
  virtual Mat3 curvature(const Vec3& p, NearestHint& /*hint*/) const { return curvature(p); }
  /** Whether a hint is of any use. */
  virtual bool searches() const { return false; }

  /** Bounds in the shape frame. */
  virtual Box3 bounds() const = 0;

  /** Whether every chord between two points of the solid stays inside it. */
  virtual bool convex() const = 0;

  /** Radius of the largest ball that fits inside, m: how deep a point can be (mesh: from below). */
  virtual double innerRadius() const = 0;

  /**
   * Its closed surface, nodes on the surface itself, no edge longer than `max_edge` (m).
   * @throws Error unless max_edge > 0, or if that would take more than four million triangles
   */
  virtual SurfaceMesh surface(double max_edge) const = 0;
};

/** @throws Error unless the sizes are positive and finite. */
std::shared_ptr<const RigidShape> makeSphere(double radius);
/** Capsule along z, its straight part of this length centred at the origin; length 0 is a sphere.
 */
std::shared_ptr<const RigidShape> makeCapsule(double radius, double length);
/** Box centred at the origin with these full edge lengths. */
std::shared_ptr<const RigidShape> makeBox(const Vec3& size);
/**
 * Solid bounded by a closed, consistently oriented triangle mesh (BVH closest point, sign by
 * angle-weighted pseudonormals). @throws Error for an open or non-manifold surface, naming `what`
 */
std::shared_ptr<const RigidShape> makeMeshShape(const Points& nodes,
                                                const std::vector<Triangle>& triangles,
                                                const std::string& what);

/** Several solids fixed to one frame: their union. */
class RigidBodyShape
{
 public:
  /** Adds a solid whose frame has pose X_TS in the body frame T. @throws Error unless X_TS is rigid
   */
  void add(std::shared_ptr<const RigidShape> shape, const Pose& X_TS);

  bool empty() const { return parts_.empty(); }
  /** Least distance to a part, body frame; +infinity while empty. */
  SignedDistance distance(const Vec3& p_T) const;
  /** Second derivative of distance(), body frame, 1/m; zero while empty. */
  Mat3 curvature(const Vec3& p_T) const;
  /** The same two, bit by bit, for many points near each other; quicker where there is one part. */
  SignedDistance distance(const Vec3& p_T, NearestHint& hint) const;
  Mat3 curvature(const Vec3& p_T, NearestHint& hint) const;
  bool searches() const { return parts_.size() == 1 && parts_[0].shape->searches(); }
  Box3 bounds() const;
  double innerRadius() const;  ///< the smallest of its parts, m; 0 while empty
  bool convex() const { return parts_.size() == 1 && parts_[0].shape->convex(); }
  /** Surfaces of all parts, body frame; nodes strictly inside another part are kept. */
  SurfaceMesh surface(double max_edge) const;

 private:
  struct Part
  {
    std::shared_ptr<const RigidShape> shape;
    Pose X_TS;
    Pose X_ST;
  };
  struct Nearest
  {
    const Part* part = nullptr;
    SignedDistance at;  ///< shape frame
  };
  Nearest nearest(const Vec3& p_T, NearestHint* hint) const;
  SignedDistance distanceTo(const Nearest& found) const;

  std::vector<Part> parts_;
};

}  // namespace soft_tissue
