#include "soft_tissue_sim/geometry/cell_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kSize = 0.4;
const CellBox kAround = {Cell::Constant(-12), Cell::Constant(12)};

/** The polygon's part with coordinate `a` at most (sign 1) or at least (-1) `at`. */
Points clipped(const Points& polygon, int a, double sign, double at)
{
  Points part;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double fp = sign * (p[a] - at), fq = sign * (q[a] - at);
    if (fp <= 0.0)
    {
      part.push_back(p);
    }
    if ((fp < 0.0) != (fq < 0.0) && fp != fq)
    {
      part.push_back(p + fp / (fp - fq) * (q - p));
    }
  }
  return part;
}

/** Area of a triangle in a cell, by clipping it at the cell's six sides. */
double areaInCell(const std::array<Vec3, 3>& triangle, const Cell& cell)
{
  Points polygon(triangle.begin(), triangle.end());
  for (int a = 0; a < 3 && polygon.size() >= 3; ++a)
  {
    polygon = clipped(polygon, a, -1.0, kSize * cell[a]);
    polygon = clipped(polygon, a, 1.0, kSize * (cell[a] + 1));
  }
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
  {
    sum += 0.5 * (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return sum.norm();
}

bool holds(const std::array<Vec3, 4>& tet, const Vec3& p)
{
  Eigen::Matrix4d all;
  for (int k = 0; k < 4; ++k)
  {
    all.col(k) << tet[k], 1.0;
  }
  const Eigen::Vector4d weights = all.inverse() * Eigen::Vector4d(p.x(), p.y(), p.z(), 1.0);
  return weights.minCoeff() >= 0.0;
}

/** Calls visit(cell) for each cell of kAround. */
template <typename Visit>
void forEachCell(const Visit& visit)
{
  for (int z = kAround.low.z(); z < kAround.high.z(); ++z)
  {
    for (int y = kAround.low.y(); y < kAround.high.y(); ++y)
    {
      for (int x = kAround.low.x(); x < kAround.high.x(); ++x)
      {
        visit(Cell(x, y, z));
      }
    }
  }
}

TEST(CellCover, OfATriangleIsWhereItsPartsAre)
{
  RandomGeometry random(1);
  for (int trial = 0; trial < 40; ++trial)
  {
    const std::array<Vec3, 3> triangle = {random.point(4.0), random.point(4.0), random.point(4.0)};
    VoxelSet cells(kSize);
    coverTriangle(triangle, cells);
    forEachCell([&](const Cell& cell) {
      const double area = areaInCell(triangle, cell);
      if (area > 1e-9)
      {
        EXPECT_TRUE(cells.occupied(cell));
      }
      else if (area == 0.0)
      {
        EXPECT_FALSE(cells.occupied(cell));
      }
    });
  }
}

// A cell has a part of a tet in it if it has a part of a face, or is all inside.
TEST(CellCover, OfATetIsThatOfItsFacesAndWhatIsInside)
{
  RandomGeometry random(2);
  for (int trial = 0; trial < 40; ++trial)
  {
    const std::array<Vec3, 4> tet = {random.point(4.0), random.point(4.0), random.point(4.0),
                                     random.point(4.0)};
    VoxelSet cells(kSize);
    coverTet(tet, cells);
    forEachCell([&](const Cell& cell) {
      double area = 0.0;
      for (int k = 0; k < 4; ++k)
      {
        area += areaInCell({tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]}, cell);
      }
      const bool inside = holds(tet, kSize * (cell.cast<double>() + Vec3::Constant(0.5)));
      if (area > 1e-9 || inside)
      {
        EXPECT_TRUE(cells.occupied(cell));
      }
      else if (area == 0.0)
      {
        EXPECT_FALSE(cells.occupied(cell));
      }
    });
  }
}

// Faces between cells belong to what is behind them.
TEST(CellCover, OfABlockOfCellsIsTheBlock)
{
  VoxelSet cells(1.0);
  const Vec3 a(0, 0, 0), b(2, 0, 0), c(2, 2, 0), d(0, 2, 0), up(0, 0, 2);
  for (const auto& tet : std::array<std::array<Vec3, 4>, 6>{{{a, b, c, c + up},
                                                             {a, c, d, c + up},
                                                             {a, d, d + up, c + up},
                                                             {a, d + up, up, c + up},
                                                             {a, up, b + up, c + up},
                                                             {a, b + up, b, c + up}}})
  {
    coverTet(tet, cells);
  }
  VoxelSet block(1.0);
  block.fill({Cell::Zero(), Cell::Constant(2)}, true);
  EXPECT_EQ(cells.contents(), block.contents());
}

TEST(CellCover, OfASheetBetweenCellsIsOneLayer)
{
  VoxelSet cells(1.0);
  coverTriangle({Vec3(0, 0, 1), Vec3(3, 0, 1), Vec3(3, 3, 1)}, cells);
  coverTriangle({Vec3(0, 0, 1), Vec3(3, 3, 1), Vec3(0, 3, 1)}, cells);
  VoxelSet layer(1.0);
  layer.fill({Cell(0, 0, 1), Cell(3, 3, 2)}, true);
  EXPECT_EQ(cells.contents(), layer.contents());
}

}  // namespace
}  // namespace soft_tissue::test
