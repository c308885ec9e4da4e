#pragma once

#include <limits>
#include <memory>

#include "soft_tissue_sim/geometry/triangle_tree.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/**
 * Depth below the surface of a deformed body at any points, exact inside and outside.
 *
 * The sign is that of the nearest feature's normal: where a body overlaps itself it tells of the
 * nearest sheet only.
 */
class DeformedDistance
{
 public:
  struct Answer
  {
    double depth = std::numeric_limits<double>::quiet_NaN();  ///< m, > 0 inside, < 0 outside
    Vec3 gradient = Vec3::Zero();  ///< unit: where depth grows; zero without depth
    Index triangle = -1;           ///< of the boundary, the nearest one
  };

  /** @param surface  closed, outward at rest; has to stay */
  explicit DeformedDistance(const BoundarySurface& surface);
  ~DeformedDistance();
  DeformedDistance(DeformedDistance&&) noexcept;

  /** Takes positions of the body's nodes, N x 3, m. @throws Error for a boundary that isn't finite
   * the first time */
  void update(const Points& x);

  /** Depth at a point; NaN for one that is no number, or before the first update. */
  Answer at(const Vec3& p) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace soft_tissue
