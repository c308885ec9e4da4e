#include "soft_tissue_sim/mesh/topology.h"

#include <algorithm>
#include <cstddef>

#include "incidence.h"
#include "soft_tissue_sim/mesh/grouping.h"

namespace soft_tissue
{
namespace
{
void collectBoundaryTriangles(Index node_count, const std::vector<Tet>& tets, BoundarySurface& out)
{
  const Adjacency faces = groupTetFaces(node_count, tets);
  std::vector<Index> single;
  for (Index row = 0; row < faces.size(); ++row)
  {
    if (faces.end(row) - faces.begin(row) == 1)
    {
      single.push_back(*faces.begin(row));
    }
  }
  std::sort(single.begin(), single.end());
  for (const Index face : single)
  {
    out.triangles.push_back(tetFace(tets[face / 4], face % 4));
    out.triangle_tet.push_back(face / 4);
  }
}

void collectBoundaryNodes(Index node_count, BoundarySurface& out)
{
  out.node_slot.assign(node_count, -1);
  for (Index node = 0; node < node_count; ++node)
  {
    if (out.node_triangles.offsets[node] != out.node_triangles.offsets[node + 1])
    {
      out.node_slot[node] = static_cast<Index>(out.nodes.size());
      out.nodes.push_back(node);
    }
  }
}

void collectBoundaryEdges(Index node_count, BoundarySurface& out)
{
  const Adjacency groups = groupTriangleEdges(node_count, out.triangles);
  out.triangle_edges.resize(out.triangles.size());
  out.triangle_neighbours.assign(out.triangles.size(), {-1, -1, -1});
  out.edges.reserve(groups.size());
  for (Index edge = 0; edge < groups.size(); ++edge)
  {
    const Index* half = groups.begin(edge);
    const Triangle& triangle = out.triangles[half[0] / 3];
    out.edges.push_back(sortedKey(Edge{triangle[half[0] % 3], triangle[(half[0] % 3 + 1) % 3]}));
    for (const Index* h = half; h != groups.end(edge); ++h)
    {
      out.triangle_edges[*h / 3][*h % 3] = edge;
    }
    if (groups.end(edge) - half == 2)
    {
      out.triangle_neighbours[half[0] / 3][half[0] % 3] = half[1] / 3;
      out.triangle_neighbours[half[1] / 3][half[1] % 3] = half[0] / 3;
    }
  }
}

/** Nodes and edges of the triangles that are there. */
void collectParts(Index node_count, BoundarySurface& out)
{
  out.node_triangles = incidence(node_count, out.triangles);
  collectBoundaryNodes(node_count, out);
  collectBoundaryEdges(node_count, out);
}
}  // namespace

Adjacency groupTetFaces(Index node_count, const std::vector<Tet>& tets)
{
  std::vector<Triangle> keys;
  keys.reserve(4 * tets.size());
  for (const Tet& tet : tets)
  {
    for (Index k = 0; k < 4; ++k)
    {
      keys.push_back(sortedKey(tetFace(tet, k)));
    }
  }
  return groupEqual(node_count, keys);
}

Adjacency groupTriangleEdges(Index node_count, const std::vector<Triangle>& triangles)
{
  std::vector<Edge> keys;
  keys.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      keys.push_back(sortedKey(Edge{triangle[k], triangle[(k + 1) % 3]}));
    }
  }
  return groupEqual(node_count, keys);
}

Adjacency nodeTets(Index node_count, const std::vector<Tet>& tets)
{
  return incidence(node_count, tets);
}

Adjacency nodeNeighbours(Index node_count, const std::vector<Tet>& tets)
{
  return elementNeighbours(node_count, tets);
}

Adjacency nodeNeighbours(Index node_count, const std::vector<Triangle>& triangles)
{
  return elementNeighbours(node_count, triangles);
}

BoundarySurface extractBoundary(Index node_count, const std::vector<Tet>& tets)
{
  BoundarySurface out;
  collectBoundaryTriangles(node_count, tets, out);
  collectParts(node_count, out);
  return out;
}

BoundarySurface surfaceOf(Index node_count, const std::vector<Triangle>& triangles)
{
  BoundarySurface out;
  out.triangles = triangles;
  collectParts(node_count, out);
  return out;
}

BoundarySurface extractPlanarBoundary(Index node_count, const std::vector<Triangle>& triangles)
{
  std::vector<std::pair<Edge, Index>> sides;  // smaller node first, and 3 triangle + corner
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, static_cast<Index>(3 * t + k)});
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<Index> single;
  for (std::size_t i = 0; i < sides.size(); ++i)
  {
    const bool with_last = i > 0 && sides[i].first == sides[i - 1].first;
    const bool with_next = i + 1 < sides.size() && sides[i].first == sides[i + 1].first;
    if (!with_last && !with_next)
    {
      single.push_back(sides[i].second);
    }
  }
  std::sort(single.begin(), single.end());
  BoundarySurface out;
  std::vector<Edge> edges;
  for (const Index side : single)
  {
    const Triangle& t = triangles[side / 3];
    edges.push_back({t[side % 3], t[(side + 1) % 3]});
    out.triangles.push_back({edges.back()[0], edges.back()[1], edges.back()[1]});
    out.triangle_tet.push_back(side / 3);
  }
  out.node_triangles = incidence(node_count, edges);
  collectBoundaryNodes(node_count, out);
  return out;
}

}  // namespace soft_tissue
