#pragma once

#include <array>
#include <vector>

#include "soft_tissue_sim/field/grid_field.h"
#include "soft_tissue_sim/geometry/closest_point.h"

namespace soft_tissue
{
/** A box of grid points: first ... last along each axis, both included. */
struct GridRegion
{
  std::array<int, 3> first, last;

  static GridRegion whole(const GridSpec& grid)
  {
    return {{0, 0, 0}, {grid.count[0] - 1, grid.count[1] - 1, grid.count[2] - 1}};
  }
  /** Points in a box, which is made wider by some cells first. */
  static GridRegion around(const GridSpec& grid, const Box3& box, int cells);

  bool empty() const { return first[0] > last[0] || first[1] > last[1] || first[2] > last[2]; }
  GridRegion common(const GridRegion& other) const;
  /** The least region that holds both. */
  GridRegion hull(const GridRegion& other) const;

  /** Calls visit(Index point) for each point. */
  template <typename Visit>
  void forPoints(const GridSpec& grid, const Visit& visit) const
  {
    for (int k = first[2]; k <= last[2]; ++k)
    {
      for (int j = first[1]; j <= last[1]; ++j)
      {
        for (int i = first[0]; i <= last[0]; ++i)
        {
          visit(grid.index(i, j, k));
        }
      }
    }
  }
};

/** Regions of boxes; those that have points in common become one. */
std::vector<GridRegion> mergedRegions(const GridSpec& grid, const std::vector<Box3>& boxes);

/** Points of a grid near a surface, with their exact distances to it. */
class GridBand
{
 public:
  struct Value
  {
    Index grid_point;
    double depth;  ///< m, < 0 outside
  };

  /** @param cells  how wide the band is, on each side */
  GridBand(const GridSpec& grid, int cells);

  /** Takes a grid of the same counts of points. */
  void place(const GridSpec& grid) { grid_ = grid; }

  /** The band within a region. A point inside the body and farther from the surface than the band
   * is wide may be nearer to a triangle that wasn't tried: it isn't in. */
  const std::vector<Value>& collect(const GridRegion& region, const BoundarySurface& surface,
                                    const Points& x);

  std::uint64_t evaluations() const { return evaluations_; }

 private:
  struct Near
  {
    Index grid_point;
    Index triangle;
    TrianglePoint nearest;
  };
  void offer(Index point, Index t, const Triangle& triangle, const Points& x);

  GridSpec grid_;
  int cells_;
  std::vector<Near> near_;
  std::vector<Index> place_;  ///< per grid point: in near_, or -1
  std::vector<Value> values_;
  std::uint64_t evaluations_ = 0;
};

}  // namespace soft_tissue
