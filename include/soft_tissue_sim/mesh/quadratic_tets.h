#pragma once

#include <array>
#include <vector>

#include "soft_tissue_sim/mesh/topology.h"

namespace soft_tissue
{
/** Nodes of a tet whose edges have a node in the middle: vertices 0 1 2 3, right handed, then those
 * of the edges 01 02 03 12 13 23. */
using QuadraticTet = std::array<Index, 10>;

/** The vertices at the ends of a quadratic tet's edges, in their order. */
constexpr int kTetEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/**
 * A mesh of quadratic tets whose edges are straight at rest.
 *
 * The nodes are the vertices and then one in the middle of each edge, in the order of the edge's
 * smaller vertex and then of the larger one: with their vertices by number, the nodes of each
 * element ascend.
 */
struct QuadraticTetMesh
{
  Points nodes;                        ///< N x 3, metres
  std::vector<QuadraticTet> elements;  ///< M x 10
  std::vector<int> tags;               ///< M region tags
};

/** Tets a quadratic one is cut into. */
constexpr int kTetParts = 8;

/** The same tets with a node added in the middle of each edge; nodes of the mesh keep their number.
 */
QuadraticTetMesh withEdgeNodes(const TetMesh& mesh);

/** The tets of a quadratic mesh by their vertices alone; it has all nodes. */
TetMesh vertexTets(const QuadraticTetMesh& mesh);

/**
 * The tets a quadratic one is cut into, of an eighth of its volume each: one at each vertex, in the
 * order of the vertices, and four around the shortest line between the middles of opposite edges.
 * @param nodes  of the mesh at rest, m
 */
std::array<Tet, kTetParts> partsOf(const QuadraticTet& element, const Points& nodes);

/** All elements cut into partsOf(): tets 8 e ... 8 e + 7 are those of element e and have its tag.
 */
TetMesh subdivided(const QuadraticTetMesh& mesh);

/** Nodes that share an element with each node. */
Adjacency nodeNeighbours(Index node_count, const std::vector<QuadraticTet>& elements);

}  // namespace soft_tissue
