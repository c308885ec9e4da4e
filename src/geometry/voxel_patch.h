#pragma once

#include "signed_surface.h"
#include "soft_tissue_sim/geometry/voxel_shape.h"

namespace soft_tissue
{
constexpr int kPatch = 16;  ///< cells along each edge of a patch

/** The surface in so many cells. */
struct VoxelShape::Patch
{
  Cell at;
  SignedSurface surface;
};

/** A point of all patches' surface. */
struct VoxelShape::Nearest
{
  Index piece = -1;  ///< number of the patch; -1: none
  SignedSurface::Nearest at;

  /** Nearer, or as near and first of all. */
  bool isBefore(const Nearest& other) const
  {
    return other.piece < 0 || at.at.squared_distance < other.at.at.squared_distance ||
           (at.at.squared_distance == other.at.at.squared_distance &&
            (piece < other.piece || (piece == other.piece && at.triangle < other.at.triangle)));
  }
  void take(const Nearest& other)
  {
    if (other.isBefore(*this))
    {
      *this = other;
    }
  }
};

}  // namespace soft_tissue
