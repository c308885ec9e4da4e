#include <algorithm>
#include <cmath>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue
{
namespace
{
/** Adds the six tets of a cell around its main diagonal; corner(i, j, k) numbers its nodes, 0 or 1.
 */
template <typename Corner>
void addCellTets(const Corner& corner, std::vector<Tet>& tets)
{
  constexpr int kAxes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int path = 0; path < 6; ++path)
  {
    std::array<int, 3> at = {0, 0, 0};
    Tet tet;
    tet[0] = corner(0, 0, 0);
    for (int step = 0; step < 3; ++step)
    {
      ++at[kAxes[path][step]];
      tet[step + 1] = corner(at[0], at[1], at[2]);
    }
    if (path >= 3)  // odd orders of the axes are left handed
    {
      std::swap(tet[1], tet[2]);
    }
    tets.push_back(tet);
  }
}

void needSize(bool good, const std::string& rule)
{
  if (!good)
  {
    throw Error("generator: must satisfy " + rule);
  }
}
}  // namespace

TetMesh makeBox(const std::array<int, 3>& cells, const Vec3& size_m)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    needSize(cells[axis] >= 1 && cells[axis] <= 1000, "1 <= cells <= 1000");
    needSize(size_m[axis] > 0.0 && size_m[axis] < 1e6, "0 < size_m < 1e6");
  }
  const auto number = [&](int i, int j, int k) {
    return static_cast<Index>((k * (cells[1] + 1) + j) * (cells[0] + 1) + i);
  };
  TetMesh mesh;
  for (int k = 0; k <= cells[2]; ++k)
  {
    for (int j = 0; j <= cells[1]; ++j)
    {
      for (int i = 0; i <= cells[0]; ++i)
      {
        const Vec3 part(double(i) / cells[0], double(j) / cells[1], double(k) / cells[2]);
        mesh.nodes.push_back(part.cwiseProduct(size_m));
        if (i < cells[0] && j < cells[1] && k < cells[2])
        {
          addCellTets([&](int a, int b, int c) { return number(i + a, j + b, k + c); }, mesh.tets);
        }
      }
    }
  }
  mesh.tags.assign(mesh.tets.size(), 1);
  return mesh;
}

std::array<int, 3> cellsForBox(const Vec3& size_m, std::size_t tets)
{
  needSize(size_m.minCoeff() > 0.0 && size_m.maxCoeff() < 1e6, "0 < size_m < 1e6");
  needSize(tets >= 6 && tets <= 20000000, "6 <= tets <= 20000000");
  const double wanted = static_cast<double>(tets) / 6.0;
  const double edge = std::cbrt(size_m.prod() / wanted);
  int longest = 0;
  size_m.maxCoeff(&longest);
  std::array<int, 3> cells = {1, 1, 1};
  double across = 1.0;  // cells in a layer across the longest edge
  for (int axis = 0; axis < 3; ++axis)
  {
    if (axis != longest)
    {
      cells[axis] = std::max(1, static_cast<int>(std::lround(size_m[axis] / edge)));
      across *= cells[axis];
    }
  }
  cells[longest] = std::max(1, static_cast<int>(std::lround(wanted / across)));
  return cells;
}

TetMesh makeTube(double inner_radius_m, double outer_radius_m, double length_m, std::size_t tets)
{
  constexpr double kPi = 3.14159265358979323846;
  needSize(inner_radius_m > 0.0 && outer_radius_m > inner_radius_m && outer_radius_m < 1e6,
           "0 < inner_radius_m < outer_radius_m < 1e6");
  needSize(length_m > 0.0 && length_m < 1e6, "0 < length_m < 1e6");
  needSize(tets >= 500 && tets <= 20000000, "500 <= tets <= 20000000");
  const double wall = outer_radius_m - inner_radius_m;
  const double round = kPi * (outer_radius_m + inner_radius_m);
  const double cells = static_cast<double>(tets) / 6.0;
  const double edge = std::cbrt(wall * round * length_m / cells);
  const int radial = std::max(1, static_cast<int>(std::lround(wall / edge)));
  const double flat_edge = std::sqrt(radial * round * length_m / cells);
  const int angular = std::max(6, static_cast<int>(std::lround(round / flat_edge)));
  const int axial = std::max(1, static_cast<int>(std::lround(cells / radial / angular)));
  const auto number = [&](int r, int a, int z) {
    return static_cast<Index>((z * angular + a % angular) * (radial + 1) + r);
  };
  TetMesh mesh;
  for (int z = 0; z <= axial; ++z)
  {
    for (int a = 0; a < angular; ++a)
    {
      for (int r = 0; r <= radial; ++r)
      {
        const double radius = inner_radius_m + wall * r / radial;
        const double angle = 2.0 * kPi * a / angular;
        mesh.nodes.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                length_m * z / axial);
        if (r < radial && z < axial)
        {
          addCellTets([&](int i, int j, int k) { return number(r + i, a + j, z + k); }, mesh.tets);
        }
      }
    }
  }
  mesh.tags.assign(mesh.tets.size(), 1);
  return mesh;
}

}  // namespace soft_tissue
