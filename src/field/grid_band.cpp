#include "grid_band.h"

#include <algorithm>
#include <cmath>

#include "surface_sign.h"

namespace soft_tissue
{
GridRegion GridRegion::around(const GridSpec& grid, const Box3& box, int cells)
{
  GridRegion region;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double end = grid.count[axis] - 1;
    const double low = (box.min[axis] - grid.origin[axis]) / grid.spacing[axis] - cells;
    const double high = (box.max[axis] - grid.origin[axis]) / grid.spacing[axis] + cells;
    region.first[axis] = static_cast<int>(std::ceil(std::clamp(low, 0.0, end + 1.0)));
    region.last[axis] = static_cast<int>(std::floor(std::clamp(high, -1.0, end)));
  }
  if (grid.count[2] == 1)  // in the plane everything is at the one height
  {
    region.first[2] = region.last[2] = 0;
  }
  return region;
}

GridRegion GridRegion::common(const GridRegion& other) const
{
  GridRegion region;
  for (int axis = 0; axis < 3; ++axis)
  {
    region.first[axis] = std::max(first[axis], other.first[axis]);
    region.last[axis] = std::min(last[axis], other.last[axis]);
  }
  return region;
}

GridRegion GridRegion::hull(const GridRegion& other) const
{
  GridRegion region;
  for (int axis = 0; axis < 3; ++axis)
  {
    region.first[axis] = std::min(first[axis], other.first[axis]);
    region.last[axis] = std::max(last[axis], other.last[axis]);
  }
  return region;
}

std::vector<GridRegion> mergedRegions(const GridSpec& grid, const std::vector<Box3>& boxes)
{
  std::vector<GridRegion> regions;
  for (const Box3& box : boxes)
  {
    GridRegion region = GridRegion::around(grid, box, 0);
    for (std::size_t i = 0; i < regions.size() && !region.empty();)
    {
      if (region.common(regions[i]).empty())
      {
        ++i;
        continue;
      }
      region = region.hull(regions[i]);
      regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
    if (!region.empty())
    {
      regions.push_back(region);
    }
  }
  return regions;
}

GridBand::GridBand(const GridSpec& grid, int cells)
    : grid_(grid), cells_(cells), place_(grid.size(), -1)
{}

const std::vector<GridBand::Value>& GridBand::collect(const GridRegion& region,
                                                      const BoundarySurface& surface,
                                                      const Points& x)
{
  near_.clear();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
  {
    const Triangle& triangle = surface.triangles[t];
    Box3 box;
    bool finite = true;
    for (const Index node : triangle)
    {
      box.extend(x[node]);
      finite = finite && x[node].allFinite();
    }
    if (!finite)  // nothing is near to it
    {
      continue;
    }
    region.common(GridRegion::around(grid_, box, cells_)).forPoints(grid_, [&](Index point) {
      offer(point, static_cast<Index>(t), triangle, x);
    });
  }
  const SurfaceSign sign(surface, x);
  const double width = cells_ * grid_.spacing.head(grid_.count[2] > 1 ? 3 : 2).minCoeff();
  values_.clear();
  for (const Near& near : near_)
  {
    place_[near.grid_point] = -1;
    const double distance = std::sqrt(near.nearest.squared_distance);
    const bool inside = sign.inside(grid_.point(near.grid_point), near.triangle, near.nearest);
    if (!inside || distance <= width)
    {
      values_.push_back({near.grid_point, inside ? distance : -distance});
    }
  }
  return values_;
}

void GridBand::offer(Index point, Index t, const Triangle& triangle, const Points& x)
{
  ++evaluations_;
  const TrianglePoint nearest =
      closestOnTriangle(grid_.point(point), x[triangle[0]], x[triangle[1]], x[triangle[2]]);
  if (place_[point] < 0)
  {
    place_[point] = static_cast<Index>(near_.size());
    near_.push_back({point, t, nearest});
  }
  else if (nearest.squared_distance < near_[place_[point]].nearest.squared_distance)
  {
    near_[place_[point]] = {point, t, nearest};
  }
}

}  // namespace soft_tissue
