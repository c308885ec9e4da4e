#pragma once

#include <vector>

#include "soft_tissue_sim/field/grid_field.h"

namespace soft_tissue
{
/** Depths between the points of a grid. */
class GridReader
{
 public:
  /** @param depth  by grid point; NaN: none */
  GridReader(const GridSpec& grid, const std::vector<double>& depth);

  /** As GridField::interpolate(). */
  double interpolate(const Vec3& p) const;

  /** As GridField::extrapolate(). */
  double extrapolate(const Vec3& p) const;

 private:
  template <typename Visit>
  void forCorners(const Vec3& p, const Visit& visit) const;
  Vec3 slopeAt(Index point) const;

  const GridSpec& grid_;
  const std::vector<double>& depth_;
  int dimension_;
  Index stride_[3];
};

}  // namespace soft_tissue
