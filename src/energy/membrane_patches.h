#pragma once

#include <array>
#include <vector>

#include "membrane_angle.h"
#include "soft_tissue_sim/energy/membrane_elasticity.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** A triangle and what lies across its edges. */
struct MembranePatch
{
  /** v0 v1 v2, and across the edges (v0, v1), (v1, v2), (v2, v0) the third node of the triangle
   * there, or -1. */
  std::array<Index, 6> nodes;
  std::array<Index, 3> angles;  ///< at those edges, or -1
  /** Per edge the places in `nodes` of the angle's a, b, c, d. */
  std::array<std::array<int, 4>, 3> places;
  /** Per edge: 1 where the angle counts as seen from this triangle's side, else -1. */
  std::array<int, 3> sides;
};

/** An edge that exactly two triangles share: (a, b, c) is the first one as it is wound, d belongs
 * to the other. */
struct MembraneAngle
{
  std::array<Index, 4> nodes;
  std::array<Index, 2> triangles;
  std::array<int, 2> edges;  ///< which of their edges it is
};

struct MembranePatches
{
  std::vector<MembranePatch> patches;  ///< one a triangle
  std::vector<MembraneAngle> angles;
};

MembranePatches findPatches(Index node_count, const std::vector<Triangle>& triangles);

/** Energy of a patch is 1/2 a^T W a, a being its angles: (0,0) (0,1) (0,2) (1,1) (1,2) (2,2), J. */
using AngleStiffness = std::array<double, 6>;

/**
 * Stiffnesses with which every constant curvature of the rest mesh has the moments of a plate.
 *
 * With K such a curvature, the angles a = M K follow from the quadratic that has it, and the moment
 * at an edge of length l and normal n should be l n^T (D K) n. Each angle has a share of its moment
 * from either side, so that of the sum over both triangles, rows of W M, is asked; W must be
 * symmetric and positive definite. Begun at W0 = A (M D^-1 M^T)^-1, which has the right energy but
 * not the moments, both are satisfied in turn.
 */
std::vector<AngleStiffness> fitAngleStiffness(const TriMesh& rest, const MembranePatches& mesh,
                                              const std::vector<MembraneParameters>& parameters);

}  // namespace soft_tissue
