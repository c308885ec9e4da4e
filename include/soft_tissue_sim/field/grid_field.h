#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "soft_tissue_sim/geometry/box3.h"
#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** Points of a regular grid; of one layer in z: a grid in the plane. */
struct GridSpec
{
  Vec3 origin = Vec3::Zero();     ///< m
  Vec3 spacing = Vec3::Ones();    ///< m, > 0
  std::array<int, 3> count = {};  ///< points along each axis, >= 2 (z: or 1)

  /** A grid of `count` points along each axis over a box, two cells wider on each side. */
  static GridSpec around(const Box3& box, const std::array<int, 3>& count);

  /** The grid itself. @throws Error for one without extent or of more than 2^30 points */
  const GridSpec& checked() const;

  Index size() const { return count[0] * count[1] * count[2]; }
  Index index(int i, int j, int k) const { return (k * count[1] + j) * count[0] + i; }
  Vec3 point(Index index) const;
};

/** Which differences the upwind scheme takes. */
enum class GridOrder
{
  first,
  second,  ///< where the two points it needs are known and fall, else first
};

/** How an update of parts of a grid went. */
struct GridUpdate
{
  Index points = 0;           ///< marched anew in boxes
  double largest_jump = 0.0;  ///< at their borders, m
  bool blended = false;       ///< some small jump was led over
  bool whole = false;         ///< a jump was too large: all was marched anew
};

/**
 * Depth inside a closed surface on a regular grid, by fast marching inwards from a band of exact
 * distances. It knows nothing of the deformation of a body: it is marched anew.
 *
 * Source: [Fisher2001].
 */
class GridField
{
 public:
  /** @throws Error for a grid without extent or with more than 2^30 points */
  GridField(const GridSpec& grid, GridOrder order);
  ~GridField();
  GridField(GridField&&) noexcept;
  GridField& operator=(GridField&&) noexcept;

  /**
   * Marches the whole grid.
   * @param surface  closed, outward; triangles, or edges in the plane z = 0 (extractPlanarBoundary)
   * @param x        N x 3, m
   */
  void march(const BoundarySurface& surface, const Points& x);

  /**
   * Marches boxes alone, after the surface has moved in them, and fits them to the rest.
   *
   * Values around a box count as they are. Where they don't fit to those found in it by the upwind
   * equation, a small difference is led over linearly across a few cells, a large one makes the
   * whole grid be marched. Boxes that overlap become one.
   * @param boxes  m; should hold all that moved, with some cells around it
   */
  GridUpdate update(const std::vector<Box3>& boxes, const BoundarySurface& surface,
                    const Points& x);

  /** Moves and stretches the grid; depths of before mean nothing until it is marched.
   * @throws Error for a grid without extent, or with other counts of points */
  void place(const GridSpec& grid);
  const GridSpec& grid() const;

  /** By grid point, m: > 0 inside, <= 0 outside within a cell or two of the surface, NaN farther
   * out. */
  const std::vector<double>& depth() const;

  /** Depth at a point: linear in its cell; NaN where the cell has a point without depth, or outside
   * the grid. */
  double interpolate(const Vec3& p) const;

  /**
   * Depth at a point by the steepest slopes at the corners of its cell, of length 1 as a distance
   * has them: the least of what they lead to. That is of second order also across ridges of the
   * field, which lines between the corners cut off. NaN where no corner has a depth.
   */
  double extrapolate(const Vec3& p) const;

  /** Distances to single triangles and solutions of the upwind equation so far. */
  std::uint64_t evaluations() const;

 private:
  class Marching;
  std::unique_ptr<Marching> marching_;
};

}  // namespace soft_tissue
