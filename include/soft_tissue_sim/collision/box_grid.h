#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/geometry/box3.h"

namespace soft_tissue
{
/**
 * Voxel grid over many small boxes: which of them overlap a given one.
 *
 * Every box stands in the one cell its centre is in and queries are grown by the largest half
 * extent, so no box is met twice. Memory is kept from one build to the next.
 */
class BoxGrid
{
 public:
  /** Fills the grid with these boxes, m; none of them may be empty or non-finite. */
  void build(const std::vector<Box3>& boxes);

  /** Bounds of all boxes. */
  const Box3& bounds() const { return bounds_; }

  /** Calls visit(index) for each box that overlaps `query`, in an order that only the boxes decide.
   */
  template <typename Visit>
  void forEachOverlap(const Box3& query, const Visit& visit) const
  {
    if (!query.overlaps(bounds_))  // also when the query is not finite
    {
      return;
    }
    const std::array<int, 3> first = cellOf(query.min - half_extent_);
    const std::array<int, 3> last = cellOf(query.max + half_extent_);
    for (int z = first[2]; z <= last[2]; ++z)
    {
      for (int y = first[1]; y <= last[1]; ++y)
      {
        const int row = (z * cells_[1] + y) * cells_[0];
        for (Index i = offsets_[row + first[0]]; i < offsets_[row + last[0] + 1]; ++i)
        {
          if (boxes_[i].overlaps(query))
          {
            visit(items_[i]);
          }
        }
      }
    }
  }

 private:
  /** The cell that holds p, or the nearest one for a point outside the bounds. */
  std::array<int, 3> cellOf(const Vec3& p) const
  {
    std::array<int, 3> cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double place = (p[axis] - bounds_.min[axis]) * cells_per_metre_[axis];
      cell[axis] = static_cast<int>(std::clamp(place, 0.0, cells_[axis] - 1.0));
    }
    return cell;
  }
  int cellNumber(const Box3& box) const;

  Box3 bounds_;
  Vec3 half_extent_ = Vec3::Zero();  ///< of the largest box, per axis
  Vec3 cells_per_metre_ = Vec3::Zero();
  std::array<int, 3> cells_ = {1, 1, 1};
  std::vector<Index> offsets_;  ///< cells + 1
  std::vector<Index> items_;    ///< box numbers, cell after cell
  std::vector<Box3> boxes_;     ///< of those items
};

}  // namespace soft_tissue
