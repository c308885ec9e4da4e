#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_tissue_sim/geometry/voxel_shape.h"
#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
/** Cells of a box whose middle is in a solid that `inside` tells. */
template <typename Inside>
VoxelSet voxelsOf(double size, const CellBox& box, const Inside& inside)
{
  VoxelSet cells(size);
  for (int z = box.low.z(); z < box.high.z(); ++z)
  {
    for (int y = box.low.y(); y < box.high.y(); ++y)
    {
      for (int x = box.low.x(); x < box.high.x(); ++x)
      {
        if (inside(Vec3(size * Vec3(x + 0.5, y + 0.5, z + 0.5))))
        {
          cells.set({x, y, z}, true);
        }
      }
    }
  }
  return cells;
}

/** Everything of a set, covered. */
inline VoxelShape wholeShape(const VoxelSet& cells)
{
  VoxelShape shape(cells);
  shape.cover(shape.bounds());
  return shape;
}

/** Signed distance to the cubes themselves, by trying every cell of a box with a free rim. */
inline double distanceToCubes(const VoxelSet& cells, const CellBox& box, const Vec3& p)
{
  const bool inside = cells.occupied(cells.cellOf(p));
  double least = std::numeric_limits<double>::infinity();
  for (int z = box.low.z(); z < box.high.z(); ++z)
  {
    for (int y = box.low.y(); y < box.high.y(); ++y)
    {
      for (int x = box.low.x(); x < box.high.x(); ++x)
      {
        if (cells.occupied({x, y, z}) != inside)
        {
          const Vec3 low = cells.cellSize() * Vec3(x, y, z);
          const Box3 cube = {low, low + Vec3::Constant(cells.cellSize())};
          least = std::min(least, cube.squaredDistance(p));
        }
      }
    }
  }
  return (inside ? -1.0 : 1.0) * std::sqrt(least);
}

/** Cells at random, so that they touch in every way cells can. */
inline VoxelSet randomVoxels(unsigned seed, const CellBox& box, double share)
{
  RandomGeometry random(seed);
  return voxelsOf(1.0, box, [&](const Vec3&) { return random.uniform(0.0, 1.0) < share; });
}

}  // namespace soft_tissue::test
