#pragma once

#include <vector>

#include "soft_tissue_sim/mesh/surface_points.h"

namespace soft_tissue
{
/** A tissue or a membrane as contact sees it; everything pointed to outlives the contact. */
struct TissueBody
{
  const std::vector<Tet>* tets = nullptr;    ///< none: a membrane
  const BoundarySurface* surface = nullptr;  ///< of the body's nodes, or of `points`
  Index first_node = 0;  ///< row of the body's node 0 in the positions of the whole scene
  Index node_count = 0;
  /** Length of short boundary edges at rest, m: what longer edges of others are cut to for their
   * quadrature; 0: not at all. */
  double short_edge = 0.0;
  /** Nodes at rest, m, N x 3; needed where the body touches itself. */
  const Points* rest = nullptr;
  /** Points that contact knows the surface by where its nodes are too few. */
  const SurfacePoints* points = nullptr;

  /** Whether others can be inside. */
  bool isSolid() const { return tets != nullptr; }
};

}  // namespace soft_tissue
