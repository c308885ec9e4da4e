#include "soft_tissue_sim/mesh/quadratic_tets.h"

#include <algorithm>

#include "incidence.h"

namespace soft_tissue
{
namespace
{
/** For each pair of opposite edges: their middles, then those of the other edges around the line
 * between them, so that it and any two neighbours among these are a right-handed tet. */
constexpr int kAround[3][6] = {{4, 9, 6, 8, 7, 5}, {5, 8, 4, 7, 9, 6}, {6, 7, 5, 9, 8, 4}};

Edge edgeOf(const Tet& tet, int edge)
{
  return {std::min(tet[kTetEdges[edge][0]], tet[kTetEdges[edge][1]]),
          std::max(tet[kTetEdges[edge][0]], tet[kTetEdges[edge][1]])};
}
}  // namespace

QuadraticTetMesh withEdgeNodes(const TetMesh& mesh)
{
  std::vector<Edge> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const Tet& tet : mesh.tets)
  {
    for (int edge = 0; edge < 6; ++edge)
    {
      edges.push_back(edgeOf(tet, edge));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

  QuadraticTetMesh quadratic;
  quadratic.tags = mesh.tags;
  quadratic.nodes = mesh.nodes;
  for (const Edge& edge : edges)
  {
    quadratic.nodes.push_back(0.5 * (mesh.nodes[edge[0]] + mesh.nodes[edge[1]]));
  }
  const auto first = static_cast<Index>(mesh.nodes.size());
  for (const Tet& tet : mesh.tets)
  {
    QuadraticTet element;
    std::copy(tet.begin(), tet.end(), element.begin());
    for (int edge = 0; edge < 6; ++edge)
    {
      const auto place = std::lower_bound(edges.begin(), edges.end(), edgeOf(tet, edge));
      element[4 + edge] = first + static_cast<Index>(place - edges.begin());
    }
    quadratic.elements.push_back(element);
  }
  return quadratic;
}

TetMesh vertexTets(const QuadraticTetMesh& mesh)
{
  TetMesh tets;
  tets.nodes = mesh.nodes;
  tets.tags = mesh.tags;
  for (const QuadraticTet& e : mesh.elements)
  {
    tets.tets.push_back({e[0], e[1], e[2], e[3]});
  }
  return tets;
}

std::array<Tet, kTetParts> partsOf(const QuadraticTet& e, const Points& nodes)
{
  const int* around = kAround[0];
  for (const auto& other : kAround)
  {
    const auto length = [&](const int* line) {
      return (nodes[e[line[1]]] - nodes[e[line[0]]]).squaredNorm();
    };
    around = length(other) < length(around) ? other : around;
  }
  std::array<Tet, kTetParts> parts = {Tet{e[0], e[4], e[5], e[6]}, Tet{e[4], e[1], e[7], e[8]},
                                      Tet{e[5], e[7], e[2], e[9]}, Tet{e[6], e[8], e[9], e[3]}};
  for (int k = 0; k < 4; ++k)
  {
    parts[4 + k] = {e[around[0]], e[around[1]], e[around[2 + k]], e[around[2 + (k + 1) % 4]]};
  }
  return parts;
}

TetMesh subdivided(const QuadraticTetMesh& mesh)
{
  TetMesh fine;
  fine.nodes = mesh.nodes;
  for (std::size_t k = 0; k < mesh.elements.size(); ++k)
  {
    const std::array<Tet, kTetParts> parts = partsOf(mesh.elements[k], mesh.nodes);
    fine.tets.insert(fine.tets.end(), parts.begin(), parts.end());
    fine.tags.insert(fine.tags.end(), kTetParts, mesh.tags[k]);
  }
  return fine;
}

Adjacency nodeNeighbours(Index node_count, const std::vector<QuadraticTet>& elements)
{
  return elementNeighbours(node_count, elements);
}

}  // namespace soft_tissue
