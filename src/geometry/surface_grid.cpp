#include "surface_grid.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr double kMostTriangles = 4e6;

Edge undirected(Index a, Index b)
{
  return a < b ? Edge{a, b} : Edge{b, a};
}

/** Row by row nodes of one triangle cut n ways: row i (0 at corner 0) has i + 1 of them. */
class TriangleGrid
{
 public:
  explicit TriangleGrid(int n) : n_(n), nodes_((n + 1) * (n + 2) / 2) {}
  Index& at(int row, int place) { return nodes_[row * (row + 1) / 2 + place]; }
  void appendTriangles(std::vector<Triangle>& triangles)
  {
    for (int row = 0; row < n_; ++row)
    {
      for (int i = 0; i <= row; ++i)
      {
        triangles.push_back({at(row, i), at(row + 1, i), at(row + 1, i + 1)});
        if (i < row)
        {
          triangles.push_back({at(row, i), at(row + 1, i + 1), at(row, i + 1)});
        }
      }
    }
  }

 private:
  int n_;
  std::vector<Index> nodes_;
};

/** The middle of each edge that is too long, made on first sight. */
class Midpoints
{
 public:
  Midpoints(Points& nodes, double max_edge) : nodes_(nodes), max_edge_(max_edge) {}

  /** Its node, or -1 if the edge is short enough. */
  Index of(Index a, Index b)
  {
    if ((nodes_[a] - nodes_[b]).norm() <= max_edge_)
    {
      return -1;
    }
    const auto found = made_.emplace(undirected(a, b), static_cast<Index>(nodes_.size()));
    if (found.second)
    {
      const Vec3 middle = 0.5 * (nodes_[a] + nodes_[b]);
      nodes_.push_back(middle);
    }
    return found.first->second;
  }

 private:
  Points& nodes_;
  double max_edge_;
  std::map<Edge, Index> made_;
};

/** One triangle cut at those of its edges (k to k+1) that have a middle node. */
void appendCut(const Triangle& corner, const Triangle& middle, std::vector<Triangle>& triangles)
{
  const auto has_middle = [](Index node) { return node >= 0; };
  const auto count = std::count_if(middle.begin(), middle.end(), has_middle);
  if (count == 0)
  {
    triangles.push_back(corner);
    return;
  }
  if (count == 3)
  {
    triangles.push_back({corner[0], middle[0], middle[2]});
    triangles.push_back({corner[1], middle[1], middle[0]});
    triangles.push_back({corner[2], middle[2], middle[1]});
    triangles.push_back(middle);
    return;
  }
  // Turn it so that the cut edges come first: edge 0, or edges 0 and 1.
  int first = 0;
  while (middle[first] < 0 || (count == 2 && middle[(first + 1) % 3] < 0))
  {
    ++first;
  }
  const Index a = corner[first];
  const Index b = corner[(first + 1) % 3];
  const Index c = corner[(first + 2) % 3];
  const Index ab = middle[first];
  if (count == 1)
  {
    triangles.push_back({a, ab, c});
    triangles.push_back({ab, b, c});
    return;
  }
  const Index bc = middle[(first + 1) % 3];
  triangles.push_back({ab, b, bc});
  triangles.push_back({a, ab, bc});
  triangles.push_back({a, bc, c});
}
}  // namespace

void requireNotNegative(double value, const std::string& what)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    throw Error(what + " = " + std::to_string(value) + ", must be finite and >= 0");
  }
}

void requirePositive(double value, const std::string& what)
{
  if (!(value > 0.0) || !std::isfinite(value))
  {
    throw Error(what + " = " + std::to_string(value) + ", must be finite and > 0");
  }
}

int pieceCount(double length, double max_edge, int least)
{
  if (!(max_edge > 0.0))
  {
    throw Error("surface: max_edge = " + std::to_string(max_edge) + " m, must be > 0");
  }
  const double pieces = std::ceil(length / max_edge);
  requireAffordable(pieces, max_edge);
  return std::max(least, static_cast<int>(pieces));
}

void requireAffordable(double triangle_count, double max_edge)
{
  if (!(triangle_count <= kMostTriangles))
  {
    throw Error("surface: max_edge = " + std::to_string(max_edge) +
                " m takes more than four million triangles");
  }
}

double longestEdge(const SurfaceMesh& mesh)
{
  double longest = 0.0;
  for (const Triangle& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      longest = std::max(longest, (mesh.nodes[t[k]] - mesh.nodes[t[(k + 1) % 3]]).norm());
    }
  }
  return longest;
}

SurfaceMesh subdivide(const SurfaceMesh& mesh, int n)
{
  SurfaceMesh fine;
  fine.nodes = mesh.nodes;
  std::map<Edge, Index> first_on_edge;  // nodes of an edge are consecutive, from its smaller end
  const auto onEdge = [&](Index from, Index to, int place) {
    const Edge edge = undirected(from, to);
    const auto found = first_on_edge.emplace(edge, static_cast<Index>(fine.nodes.size()));
    for (int i = 1; found.second && i < n; ++i)
    {
      const double t = static_cast<double>(i) / n;
      fine.nodes.push_back((1.0 - t) * mesh.nodes[edge[0]] + t * mesh.nodes[edge[1]]);
    }
    return found.first->second + (from == edge[0] ? place : n - place) - 1;
  };
  TriangleGrid grid(n);
  for (const Triangle& t : mesh.triangles)
  {
    for (int row = 0; row <= n; ++row)
    {
      for (int i = 0; i <= row; ++i)
      {
        Index& node = grid.at(row, i);
        const bool corner = row == 0 || (row == n && (i == 0 || i == n));
        if (corner)
        {
          node = row == 0 ? t[0] : (i == 0 ? t[1] : t[2]);
        }
        else if (i == 0 || i == row || row == n)
        {
          node = i == 0 ? onEdge(t[0], t[1], row)
                        : (i == row ? onEdge(t[0], t[2], row) : onEdge(t[1], t[2], i));
        }
        else
        {
          node = static_cast<Index>(fine.nodes.size());
          fine.nodes.push_back(
              ((n - row) * mesh.nodes[t[0]] + (row - i) * mesh.nodes[t[1]] + i * mesh.nodes[t[2]]) /
              n);
        }
      }
    }
    grid.appendTriangles(fine.triangles);
  }
  return fine;
}

SurfaceMesh splitLongEdges(SurfaceMesh mesh, double max_edge)
{
  pieceCount(0.0, max_edge, 0);
  for (std::size_t before = 0; before != mesh.triangles.size();)
  {
    before = mesh.triangles.size();
    Midpoints midpoints(mesh.nodes, max_edge);
    std::vector<Triangle> triangles;
    for (const Triangle& t : mesh.triangles)
    {
      appendCut(t, {midpoints.of(t[0], t[1]), midpoints.of(t[1], t[2]), midpoints.of(t[2], t[0])},
                triangles);
    }
    mesh.triangles = std::move(triangles);
    requireAffordable(static_cast<double>(mesh.triangles.size()), max_edge);
  }
  return mesh;
}

}  // namespace soft_tissue
