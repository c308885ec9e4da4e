#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/field/grid_field.h"

namespace soft_tissue
{
namespace
{
constexpr Index kMostPoints = 1 << 30;
}  // namespace

const GridSpec& GridSpec::checked() const
{
  double points = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int least = axis == 2 ? 1 : 2;
    if (count[axis] < least || !(spacing[axis] > 0.0))
    {
      throw Error("grid field: axis " + std::to_string(axis) + " has " +
                  std::to_string(count[axis]) + " points " + std::to_string(spacing[axis]) +
                  " m apart, must be at least " + std::to_string(least) + " and > 0");
    }
    points *= count[axis];
  }
  if (points > kMostPoints)
  {
    throw Error("grid field: " + std::to_string(points) + " points, must be at most 2^30");
  }
  return *this;
}

GridSpec GridSpec::around(const Box3& box, const std::array<int, 3>& count)
{
  GridSpec grid;
  grid.count = count;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double extent = box.max[axis] - box.min[axis];
    grid.spacing[axis] = count[axis] > 5 ? extent / (count[axis] - 5) : 1.0;
    grid.origin[axis] = box.min[axis] - (count[axis] > 5 ? 2.0 * grid.spacing[axis] : 0.0);
  }
  return grid;
}

Vec3 GridSpec::point(Index index) const
{
  const Index i = index % count[0], j = index / count[0] % count[1];
  return origin + Vec3(i, j, index / count[0] / count[1]).cwiseProduct(spacing);
}

}  // namespace soft_tissue
