#include "field_bodies.h"

#include <cmath>
#include <functional>

#include "soft_tissue_sim/geometry/box3.h"
#include "turned_surface.h"

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

/** A point of the half plane y = 0, x >= 0 that a surface is turned out of. */
using Profile = std::function<Vec3(double)>;

/** Points in the box around a surface, evenly, that are inside by its winding number. */
Points samplesInside(const Points& x, const std::vector<Triangle>& triangles)
{
  constexpr int kAcross = 16;
  const Box3 box = boundsOf(x);
  Points samples;
  for (int i = 0; i < kAcross * kAcross * kAcross; ++i)
  {
    const Vec3 place(i % kAcross + 0.5, i / kAcross % kAcross + 0.5, i / kAcross / kAcross + 0.5);
    const Vec3 p = box.min + (box.max - box.min).cwiseProduct(place) / kAcross;
    double angle = 0.0;  // the solid angle of all triangles
    for (const Triangle& t : triangles)
    {
      const Vec3 a = x[t[0]] - p, b = x[t[1]] - p, c = x[t[2]] - p;
      angle +=
          2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                  b.dot(c) * a.norm() + c.dot(a) * b.norm());
    }
    if (angle > 2.0 * M_PI)
    {
      samples.push_back(p);
    }
  }
  return samples;
}

/** A body of a turned profile, given for 0 ... 1: from pole to pole, or once around. */
FieldBody turned(const std::string& name, const Profile& profile, bool poles, int around, int rows)
{
  Points line;
  for (int row = 0; row < rows + (poles ? 1 : 0); ++row)
  {
    line.push_back(profile(static_cast<double>(row) / rows));
  }
  if (poles)
  {
    line.front().x() = line.back().x() = 0.0;
  }
  const TriMesh mesh = turnedSurface(line, around, !poles);
  FieldBody body;
  body.name = name;
  body.x = mesh.nodes;
  body.elements = mesh.triangles.size();
  // The boundary of a cone over a closed surface, whatever its shape, is that surface.
  const Index tip = static_cast<Index>(body.x.size());
  std::vector<Tet> cone;
  for (const Triangle& t : mesh.triangles)
  {
    cone.push_back({tip, t[0], t[1], t[2]});
  }
  const Points samples = samplesInside(body.x, mesh.triangles);
  body.x.insert(body.x.end(), samples.begin(), samples.end());
  body.surface = extractBoundary(static_cast<Index>(body.x.size()), cone);
  return body;
}
}  // namespace

FieldBody sphereOfTriangles()
{
  return turned(
      "sphere", [](double t) { return Vec3(std::sin(M_PI * t), 0.0, -std::cos(M_PI * t)); }, true,
      27, 19);
}

FieldBody torusOfTriangles()
{
  return turned(
      "torus of triangles",
      [](double t) {
        return Vec3(1.0 + 0.4 * std::sin(2.0 * M_PI * t), 0.0, -0.4 * std::cos(2.0 * M_PI * t));
      },
      false, 64, 16);
}

FieldBody appleOfTriangles()
{
  return turned(
      "apple",
      [](double t) {
        const double radius = 0.4 + 0.6 * std::sin(M_PI * t);
        return Vec3(radius * std::sin(M_PI * t), 0.0, -radius * std::cos(M_PI * t));
      },
      true, 16, 13);
}

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

FieldBody disc()
{
  constexpr int kRings = 12;
  constexpr double kNodesPerRing = 485.0 / 78.0;  // times 1 ... 12, and the middle: 486
  Points x = {Vec3::Zero()};
  std::vector<Triangle> triangles;
  Index inner = 0;
  int inner_count = 0;
  for (int ring = 1; ring <= kRings; ++ring)
  {
    const Index outer = static_cast<Index>(x.size());
    const int outer_count = static_cast<int>(std::lround(kNodesPerRing * ring));
    for (int k = 0; k < outer_count; ++k)
    {
      const double angle = 2.0 * M_PI * k / outer_count;
      x.emplace_back(std::cos(angle) * ring / kRings, std::sin(angle) * ring / kRings, 0.0);
    }
    // Once around both rings, on the one that is behind.
    for (int i = 0, j = 0; i < inner_count || j < outer_count;)
    {
      const Index a = inner + (inner_count > 0 ? i % inner_count : 0);
      const Index b = outer + j % outer_count;
      if (i == inner_count || (j < outer_count && (j + 1) * inner_count <= (i + 1) * outer_count))
      {
        triangles.push_back({a, b, outer + ++j % outer_count});
      }
      else
      {
        triangles.push_back({a, b, inner + ++i % inner_count});
      }
    }
    inner = outer;
    inner_count = outer_count;
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
