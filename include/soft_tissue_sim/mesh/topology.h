#pragma once

#include <vector>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** Compressed rows: the items of row i are items[offsets[i]] ... items[offsets[i+1]-1], ascending.
 */
struct Adjacency
{
  std::vector<Index> offsets;
  std::vector<Index> items;

  const Index* begin(Index row) const { return items.data() + offsets[row]; }
  const Index* end(Index row) const { return items.data() + offsets[row + 1]; }
  Index size() const { return static_cast<Index>(offsets.size()) - 1; }
};

/** Nodes that share an edge with each node. */
Adjacency nodeNeighbours(Index node_count, const std::vector<Tet>& tets);
Adjacency nodeNeighbours(Index node_count, const std::vector<Triangle>& triangles);

/** Tets that contain each node. */
Adjacency nodeTets(Index node_count, const std::vector<Tet>& tets);

/** The boundary of a tet mesh: faces that belong to exactly one tet. Node numbers are the tet
 * mesh's. */
struct BoundarySurface
{
  std::vector<Triangle> triangles;  ///< outward (counter-clockwise from outside) in the rest state
  std::vector<Index> triangle_tet;  ///< the tet each triangle belongs to
  std::vector<Index> nodes;         ///< nodes on the boundary, ascending
  std::vector<Index> node_slot;     ///< per tet-mesh node: its place in `nodes`, or -1 inside
  std::vector<Edge> edges;          ///< each undirected edge once, smaller node first, ascending
  std::vector<std::array<Index, 3>>
      triangle_edges;  ///< per triangle: edge (v0,v1), (v1,v2), (v2,v0)
  std::vector<std::array<Index, 3>>
      triangle_neighbours;   ///< across those edges; -1 open or non-manifold
  Adjacency node_triangles;  ///< rows: all tet-mesh nodes (empty inside); triangles that contain it
};

BoundarySurface extractBoundary(Index node_count, const std::vector<Tet>& tets);

/** Triangles, open or closed, as a surface of their own: all of BoundarySurface but triangle_tet.
 */
BoundarySurface surfaceOf(Index node_count, const std::vector<Triangle>& triangles);

/**
 * The boundary of a mesh of triangles in a plane: edges that belong to exactly one of them, each as
 * a triangle whose last two corners are one. What measures distances to triangles then does the
 * same in two dimensions. Of BoundarySurface only triangles, triangle_tet (the number of the
 * triangle), nodes, node_slot and node_triangles are set.
 */
BoundarySurface extractPlanarBoundary(Index node_count, const std::vector<Triangle>& triangles);

}  // namespace soft_tissue
