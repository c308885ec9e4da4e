#include "soft_tissue_sim/geometry/cell_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace soft_tissue
{
namespace
{
/** Where a solid is along an axis, and how far half a cell reaches along it. */
struct Shadow
{
  Vec3 axis;
  double low, high, half_cell;
};

/** The axes that may have a solid on one side and a cell on the other, but for the cell's own. */
class Shadows
{
 public:
  explicit Shadows(double cell_size) : cell_size_(cell_size) {}

  template <std::size_t N>
  void add(const Vec3& axis, const std::array<Vec3, N>& corners)
  {
    Shadow shadow = {axis, axis.dot(corners[0]), axis.dot(corners[0]),
                     0.5 * cell_size_ * axis.cwiseAbs().sum()};
    for (const Vec3& corner : corners)
    {
      shadow.low = std::min(shadow.low, axis.dot(corner));
      shadow.high = std::max(shadow.high, axis.dot(corner));
    }
    if (shadow.half_cell > 0.0)
    {
      shadows_[count_++] = shadow;
    }
  }

  template <std::size_t N>
  void addEdges(const std::array<Vec3, N>& corners)
  {
    for (std::size_t i = 0; i < N; ++i)
    {
      for (std::size_t j = i + 1; j < N; ++j)
      {
        for (int a = 0; a < 3; ++a)
        {
          add(Vec3::Unit(a).cross(corners[j] - corners[i]), corners);
        }
      }
    }
  }

  bool reach(const Vec3& middle) const
  {
    return std::all_of(shadows_.begin(), shadows_.begin() + count_, [&](const Shadow& shadow) {
      const double at = shadow.axis.dot(middle);
      // What is flat along the axis touches as long as it is not beyond the cell.
      const double rounding = shadow.high - shadow.low < kFlat * shadow.half_cell
                                  ? kFlat * shadow.half_cell
                                  : -kFlat * shadow.half_cell;
      return at - shadow.half_cell < shadow.high + rounding &&
             at + shadow.half_cell > shadow.low - rounding;
    });
  }

 private:
  static constexpr double kFlat = 1e-9;

  double cell_size_;
  std::array<Shadow, 22> shadows_;
  int count_ = 0;
};

template <std::size_t N>
void cover(const std::array<Vec3, N>& corners, const Shadows& shadows, VoxelSet& cells)
{
  const double size = cells.cellSize();
  CellBox box;
  for (int a = 0; a < 3; ++a)
  {
    double low = corners[0][a] / size, high = low;
    for (const Vec3& corner : corners)
    {
      low = std::min(low, corner[a] / size);
      high = std::max(high, corner[a] / size);
    }
    box.low[a] = static_cast<int>(std::floor(low));
    box.high[a] =
        std::max(static_cast<int>(std::ceil(high)), box.low[a] + 1);  // flat ones are in one cell
  }
  Cell at;
  for (at.z() = box.low.z(); at.z() < box.high.z(); ++at.z())
  {
    for (at.y() = box.low.y(); at.y() < box.high.y(); ++at.y())
    {
      for (at.x() = box.low.x(); at.x() < box.high.x(); ++at.x())
      {
        const Vec3 middle = size * (at.cast<double>() + Vec3::Constant(0.5));
        if (!cells.occupied(at) && shadows.reach(middle))
        {
          cells.set(at, true);
        }
      }
    }
  }
}
}  // namespace

void coverTet(const std::array<Vec3, 4>& tet, VoxelSet& cells)
{
  Shadows shadows(cells.cellSize());
  for (int k = 0; k < 4; ++k)
  {
    const Vec3 &a = tet[(k + 1) % 4], &b = tet[(k + 2) % 4], &c = tet[(k + 3) % 4];
    shadows.add((b - a).cross(c - a), tet);
  }
  shadows.addEdges(tet);
  cover(tet, shadows, cells);
}

void coverTriangle(const std::array<Vec3, 3>& triangle, VoxelSet& cells)
{
  Shadows shadows(cells.cellSize());
  shadows.add((triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]), triangle);
  shadows.addEdges(triangle);
  cover(triangle, shadows, cells);
}

}  // namespace soft_tissue
