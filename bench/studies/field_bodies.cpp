#include "field_bodies.h"

#include <cmath>
#include <functional>

namespace soft_tissue::studies
{
namespace
{
FieldBody bodyOfTriangles(const std::string& name, const Points& x,
                          const std::vector<Triangle>& triangles)
{
  FieldBody body;
  body.name = name;
  body.dimension = 2;
  body.elements = triangles.size();
  body.x = x;
  body.neighbours = nodeNeighbours(static_cast<Index>(x.size()), triangles);
  body.surface = extractPlanarBoundary(static_cast<Index>(x.size()), triangles);
  return body;
}

/** How far a node of a lattice is moved, in cells: uneven, as meshes are, but not at the borders.
 */
double shifted(int along, int across, int count)
{
  const bool border = along == 0 || along == count - 1;
  return border ? 0.0 : 0.3 * std::sin(12.9898 * along + 78.233 * across);
}

/** Cells of a lattice of columns x rows nodes for which keep(column, row) holds. */
FieldBody lattice(const std::string& name, int columns, int rows,
                  const std::function<bool(int, int)>& keep)
{
  constexpr double kHeight = 0.625;
  Points x;
  std::vector<Index> number(columns * rows, -1);
  std::vector<Triangle> triangles;
  const auto node = [&](int column, int row) {
    Index& found = number[row * columns + column];
    if (found < 0)
    {
      found = static_cast<Index>(x.size());
      x.emplace_back((column + shifted(column, row, columns)) / (columns - 1.0),
                     kHeight * (row + shifted(row, column, rows)) / (rows - 1.0), 0.0);
    }
    return found;
  };
  for (int row = 0; row + 1 < rows; ++row)
  {
    for (int column = 0; column + 1 < columns; ++column)
    {
      if (!keep(column, row))
      {
        continue;
      }
      const Index a = node(column, row), b = node(column + 1, row);
      const Index c = node(column + 1, row + 1), d = node(column, row + 1);
      if ((row + column) % 2 == 0)
      {
        triangles.push_back({a, b, c});
        triangles.push_back({a, c, d});
      }
      else
      {
        triangles.push_back({a, b, d});
        triangles.push_back({b, c, d});
      }
    }
  }
  return bodyOfTriangles(name, x, triangles);
}
}  // namespace

FieldBody bodyOfTets(const std::string& name, const TetMesh& mesh)
{
  FieldBody body;
  body.name = name;
  body.elements = mesh.tets.size();
  body.x = mesh.nodes;
  body.neighbours = nodeNeighbours(static_cast<Index>(mesh.nodes.size()), mesh.tets);
  body.surface = extractBoundary(static_cast<Index>(mesh.nodes.size()), mesh.tets);
  return body;
}

FieldBody disc(int rings)
{
  Points x = {Vec3::Zero()};
  std::vector<Triangle> triangles;
  Index inner = 0;
  for (int ring = 1; ring <= rings; ++ring)
  {
    const Index outer = static_cast<Index>(x.size());
    const int outer_count = 6 * ring, inner_count = 6 * (ring - 1);
    for (int k = 0; k < outer_count; ++k)
    {
      const double angle = 2.0 * M_PI * k / outer_count;
      x.emplace_back(std::cos(angle) * ring / rings, std::sin(angle) * ring / rings, 0.0);
    }
    for (int sector = 0; sector < 6; ++sector)
    {
      const auto outerNode = [&](int k) { return outer + (sector * ring + k) % outer_count; };
      const auto innerNode = [&](int k) {
        return ring == 1 ? 0 : inner + (sector * (ring - 1) + k) % inner_count;
      };
      for (int k = 0; k < ring; ++k)
      {
        triangles.push_back({innerNode(k), outerNode(k), outerNode(k + 1)});
        if (k + 1 < ring)
        {
          triangles.push_back({innerNode(k), outerNode(k + 1), innerNode(k + 1)});
        }
      }
    }
    inner = outer;
  }
  return bodyOfTriangles("disc", x, triangles);
}

FieldBody rectangle(int columns, int rows)
{
  return lattice("rectangle", columns, rows, [](int, int) { return true; });
}

FieldBody cutRectangle(int columns, int rows)
{
  return lattice("cut rectangle", columns, rows, [=](int column, int row) {
    const bool quarter = 2 * column >= columns && 2 * row >= rows;
    const bool slit = column == columns / 4 && 2 * row < rows;
    return !quarter && !slit;
  });
}

}  // namespace soft_tissue::studies
