#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"

#include <algorithm>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** The nodes of all elements, each with its vertices by number: blocks are then above the diagonal.
 */
std::vector<Index> ascendingNodes(const std::vector<QuadraticTet>& elements)
{
  std::vector<Index> nodes;
  nodes.reserve(10 * elements.size());
  for (std::size_t k = 0; k < elements.size(); ++k)
  {
    QuadraticTet sorted = elements[k];
    std::sort(sorted.begin(), sorted.begin() + 4);
    for (int edge = 0; edge < 6; ++edge)
    {
      for (int old = 0; old < 6; ++old)
      {
        const Index a = elements[k][kTetEdges[old][0]], b = elements[k][kTetEdges[old][1]];
        if (std::min(a, b) == sorted[kTetEdges[edge][0]] &&
            std::max(a, b) == sorted[kTetEdges[edge][1]])
        {
          sorted[4 + edge] = elements[k][4 + old];
        }
      }
    }
    if (!std::is_sorted(sorted.begin(), sorted.end()))
    {
      throw Error("nodes of quadratic tet " + std::to_string(k) +
                  " must ascend from vertices to edges and from edge to edge");
    }
    nodes.insert(nodes.end(), sorted.begin(), sorted.end());
  }
  return nodes;
}

/** Barycentric coordinates of the middle of each part of each element, by ascending vertices. */
std::vector<double> partMiddles(const QuadraticTetMesh& mesh)
{
  std::vector<double> places;
  places.reserve(4 * kTetParts * mesh.elements.size());
  for (const QuadraticTet& element : mesh.elements)
  {
    std::array<Index, 4> vertices = {element[0], element[1], element[2], element[3]};
    std::sort(vertices.begin(), vertices.end());
    for (const Tet& part : partsOf(element, mesh.nodes))
    {
      std::array<double, 4> middle = {};
      for (const Index node : part)
      {
        const auto place = std::find(element.begin(), element.end(), node) - element.begin();
        const int* edge = kTetEdges[place < 4 ? 0 : place - 4];
        for (int k = 0; k < 4; ++k)
        {
          middle[k] += place < 4 ? 0.25 * (vertices[k] == node)
                                 : 0.125 * (vertices[k] == element[edge[0]]) +
                                       0.125 * (vertices[k] == element[edge[1]]);
        }
      }
      places.insert(places.end(), middle.begin(), middle.end());
    }
  }
  return places;
}
}  // namespace

QuadraticTetElasticity::QuadraticTetElasticity(
    const QuadraticTetMesh& rest, MaterialModel model,
    const std::vector<TetStiffnessParameters>& parameters, Index first_node)
    : Elasticity(quadraticTetKernels(model, instructionSet()), vertexTets(rest),
                 ascendingNodes(rest.elements), parameters, first_node)
{
  setPlaces(partMiddles(rest));
}

}  // namespace soft_tissue
