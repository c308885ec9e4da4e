#include <cstdint>
#include <random>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue
{
namespace
{
constexpr double kShaken = 0.2;  // of a cell: no triangle can turn over

/** In [0, 1); distributions of the standard library differ from one to the next. */
double draw(std::mt19937& random)
{
  return static_cast<double>(random()) / 4294967296.0;
}

void checkSheet(const std::array<int, 2>& cells, const std::array<double, 2>& size_m)
{
  for (int axis = 0; axis < 2; ++axis)
  {
    if (cells[axis] < 1 || cells[axis] > 1000)
    {
      throw Error("generator: must satisfy 1 <= cells <= 1000");
    }
    if (!(size_m[axis] > 0.0 && size_m[axis] < 1e6))
    {
      throw Error("generator: must satisfy 0 < size_m < 1e6");
    }
  }
}
}  // namespace

TriMesh makeSheet(const std::array<int, 2>& cells, const std::array<double, 2>& size_m,
                  SheetPattern pattern)
{
  checkSheet(cells, size_m);
  std::mt19937 random(1);
  TriMesh mesh;
  for (int j = 0; j <= cells[1]; ++j)
  {
    for (int i = 0; i <= cells[0]; ++i)
    {
      const bool inside = i > 0 && j > 0 && i < cells[0] && j < cells[1];
      double x = i, y = j;
      if (inside && pattern == SheetPattern::irregular)
      {
        x += kShaken * (2.0 * draw(random) - 1.0);
        y += kShaken * (2.0 * draw(random) - 1.0);
      }
      mesh.nodes.emplace_back(size_m[0] * (x / cells[0]), size_m[1] * (y / cells[1]), 0.0);
    }
  }
  for (int j = 0; j < cells[1]; ++j)
  {
    for (int i = 0; i < cells[0]; ++i)
    {
      const Index a = j * (cells[0] + 1) + i, b = a + 1, d = a + cells[0] + 1, c = d + 1;
      if (pattern == SheetPattern::crossed)
      {
        const auto middle = static_cast<Index>(mesh.nodes.size());
        mesh.nodes.push_back(0.5 * (mesh.nodes[a] + mesh.nodes[c]));
        const Triangle quarters[] = {
            {a, b, middle}, {b, c, middle}, {c, d, middle}, {d, a, middle}};
        mesh.triangles.insert(mesh.triangles.end(), quarters, quarters + 4);
        continue;
      }
      const bool other = pattern == SheetPattern::alternating
                             ? (i + j) % 2 == 1
                             : pattern == SheetPattern::irregular && draw(random) < 0.5;
      mesh.triangles.push_back(other ? Triangle{a, b, d} : Triangle{a, b, c});
      mesh.triangles.push_back(other ? Triangle{b, c, d} : Triangle{a, c, d});
    }
  }
  return mesh;
}

}  // namespace soft_tissue
