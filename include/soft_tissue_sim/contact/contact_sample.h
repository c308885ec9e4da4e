#pragma once

#include <array>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * One quadrature point of the contact energy E = integral of 1/2 kappa d^2 dA.
 *
 * Both responses, point- and segment-in-object, both directions of a pair, and every kind of depth
 * end as samples: energy 1/2 kappa area d^2, and d's derivative by node j is coefficient[j] *
 * gradient. The two directions are averaged by halving the area of each: areas of one direction add
 * up to half of the touching surface, and energies and forces are plain sums over all samples.
 * Where only one direction is taken, as against an obstacle, its areas count whole.
 *
 * The force is kappa area depth; while bodies that began in each other are pushed apart, what of
 * the depth they are still allowed counts neither in it nor in the energy. Where an edge is clipped
 * at a surface, the quadrature points move with that surface; the derivative of that is one more
 * sample at the clip point, with a force (small, of either sign) but without depth and area.
 */
struct ContactSample
{
  static constexpr int kMaxNodes = 7;  ///< a triangle's three nodes and a tet's four

  Vec3 position = Vec3::Zero();         ///< m, world
  Vec3 gradient = Vec3::Zero();         ///< of d by the intruding point; unit for a true distance
  double depth = 0.0;                   ///< m, >= 0
  double allowed = 0.0;                 ///< m of it that press nothing, see excess()
  double stiffness_area = 0.0;          ///< kappa times area, N/m
  double area = 0.0;                    ///< m^2, its share of the surface
  double force = 0.0;                   ///< N, against the gradient on the intruder
  int count = 0;                        ///< nodes that d depends on
  std::array<Index, kMaxNodes> node{};  ///< rows of x
  std::array<double, kMaxNodes> coefficient{};  ///< intruder weights, minus host weights
  /** Who intrudes: +1 the first of the pair, which is the tool where there is one; -1 the second.
   */
  int side = 0;
  Index host = -1;     ///< tet of the host that the point is in; -1: the host is a tool
  Index element = -1;  ///< point or edge of the intruding surface

  /** Depth that presses, m. */
  double excess() const { return depth - allowed; }

  /** Force on the first of the pair, N, world; it acts at `position`. */
  Vec3 forceOnFirst() const { return -side * force * gradient; }
  /** Out of the second of the pair, unit: the way the first is pushed. */
  Vec3 normal() const { return -side * gradient.normalized(); }
};

/** Friction between two bodies at one place. */
struct FrictionForce
{
  Vec3 position = Vec3::Zero();  ///< m, world
  Vec3 normal = Vec3::Zero();    ///< out of the second, unit
  Vec3 on_first = Vec3::Zero();  ///< N, world
};

}  // namespace soft_tissue
