#include "soft_tissue_sim/mesh/quadratic_tets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "soft_tissue_sim/mesh/generate.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
using namespace test;

double volume6(const TetMesh& mesh, std::size_t tet)
{
  const Tet& n = mesh.tets[tet];
  return signedVolume6(mesh.nodes[n[0]], mesh.nodes[n[1]], mesh.nodes[n[2]], mesh.nodes[n[3]]);
}

/** A box whose nodes are moved by up to a fifth of a cell. */
TetMesh shakenBox()
{
  TetMesh mesh = makeBox({3, 2, 2}, {3.0, 2.0, 2.0});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  for (Vec3& p : mesh.nodes)
  {
    p += Vec3(uniform(random), uniform(random), uniform(random));
  }
  for (std::size_t t = 0; t < mesh.tags.size(); ++t)
  {
    mesh.tags[t] = static_cast<int>(t);
  }
  return mesh;
}

TEST(QuadraticTets, HaveOneNodeInTheMiddleOfEachEdge)
{
  const TetMesh mesh = shakenBox();
  const QuadraticTetMesh quadratic = withEdgeNodes(mesh);
  std::map<std::set<Index>, Index> seen;
  ASSERT_EQ(quadratic.elements.size(), mesh.tets.size());
  EXPECT_EQ(quadratic.tags, mesh.tags);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
  {
    const QuadraticTet& nodes = quadratic.elements[e];
    for (int k = 0; k < 4; ++k)
    {
      ASSERT_EQ(nodes[k], mesh.tets[e][k]);
    }
    for (int edge = 0; edge < 6; ++edge)
    {
      const Index a = nodes[kTetEdges[edge][0]], b = nodes[kTetEdges[edge][1]];
      const Index middle = nodes[4 + edge];
      EXPECT_EQ(seen.emplace(std::set<Index>{a, b}, middle).first->second, middle);
      EXPECT_LT((quadratic.nodes[middle] - 0.5 * (mesh.nodes[a] + mesh.nodes[b])).norm(), 1e-15);
    }
  }
  EXPECT_EQ(quadratic.nodes.size(), mesh.nodes.size() + seen.size());
  EXPECT_TRUE(std::equal(mesh.nodes.begin(), mesh.nodes.end(), quadratic.nodes.begin()));
  const TetMesh vertices = vertexTets(quadratic);
  EXPECT_EQ(vertices.tets, mesh.tets);
  EXPECT_EQ(vertices.nodes.size(), quadratic.nodes.size());
}

TEST(QuadraticTets, AreNumberedByTheirEdgesVertices)
{
  const QuadraticTetMesh mesh = withEdgeNodes(shakenBox());
  std::map<Index, std::array<Index, 2>> edges;
  for (const QuadraticTet& nodes : mesh.elements)
  {
    for (int edge = 0; edge < 6; ++edge)
    {
      const Index a = nodes[kTetEdges[edge][0]], b = nodes[kTetEdges[edge][1]];
      edges[nodes[4 + edge]] = {std::min(a, b), std::max(a, b)};
    }
  }
  std::array<Index, 2> last = {-1, -1};
  for (const auto& [node, edge] : edges)
  {
    EXPECT_LT(last, edge) << node;
    last = edge;
  }
}

TEST(QuadraticTets, AreCutIntoEighths)
{
  const TetMesh mesh = shakenBox();
  const TetMesh fine = subdivided(withEdgeNodes(mesh));
  ASSERT_EQ(fine.tets.size(), 8 * mesh.tets.size());
  ASSERT_EQ(fine.tags.size(), fine.tets.size());
  for (std::size_t t = 0; t < fine.tets.size(); ++t)
  {
    const double whole = volume6(mesh, t / 8);
    EXPECT_NEAR(volume6(fine, t), whole / 8.0, 1e-14) << t;
    EXPECT_EQ(fine.tags[t], mesh.tags[t / 8]);
  }
  // Parts fit together: no face but those on the surface belongs to one tet alone.
  const BoundarySurface coarse_surface = extractBoundary(mesh.nodes.size(), mesh.tets);
  const BoundarySurface surface = extractBoundary(fine.nodes.size(), fine.tets);
  EXPECT_EQ(surface.triangles.size(), 4 * coarse_surface.triangles.size());
  double area = 0.0, coarse_area = 0.0;
  const auto areaOf = [](const Triangle& t, const Points& nodes) {
    return (nodes[t[1]] - nodes[t[0]]).cross(nodes[t[2]] - nodes[t[0]]).norm();
  };
  for (const Triangle& t : surface.triangles)
  {
    area += areaOf(t, fine.nodes);
  }
  for (const Triangle& t : coarse_surface.triangles)
  {
    coarse_area += areaOf(t, mesh.nodes);
  }
  EXPECT_NEAR(area, coarse_area, 1e-13 * coarse_area);
}

TEST(QuadraticTets, HaveAVertexInEachOfTheFirstFourParts)
{
  const QuadraticTetMesh mesh = withEdgeNodes(shakenBox());
  for (const QuadraticTet& element : mesh.elements)
  {
    const auto parts = partsOf(element, mesh.nodes);
    for (int k = 0; k < 4; ++k)
    {
      EXPECT_NE(std::find(parts[k].begin(), parts[k].end(), element[k]), parts[k].end());
    }
  }
}

TEST(QuadraticTets, AreCutAlongTheShortestInnerLine)
{
  // Squeezed along the line between the middles of edges that stand opposite each other.
  const int pairs[3][2] = {{4, 9}, {5, 8}, {6, 7}};
  for (const auto& pair : pairs)
  {
    TetMesh mesh = unitTet();
    const QuadraticTet n = withEdgeNodes(mesh).elements[0];
    const QuadraticTetMesh before = withEdgeNodes(mesh);
    const Vec3 line = (before.nodes[n[pair[1]]] - before.nodes[n[pair[0]]]).normalized();
    for (Vec3& p : mesh.nodes)
    {
      p -= 0.8 * line * line.dot(p);
    }
    const QuadraticTetMesh squeezed = withEdgeNodes(mesh);
    const auto parts = partsOf(n, squeezed.nodes);
    for (int part = 4; part < 8; ++part)
    {
      for (const int end : pair)
      {
        EXPECT_NE(std::find(parts[part].begin(), parts[part].end(), n[end]), parts[part].end());
      }
    }
  }
}

TEST(QuadraticTets, CoupleAllNodesOfAnElement)
{
  const QuadraticTetMesh mesh = withEdgeNodes(twoTets());
  const Adjacency rows = nodeNeighbours(static_cast<Index>(mesh.nodes.size()), mesh.elements);
  ASSERT_EQ(rows.size(), 14);  // 5 vertices, 9 edges
  std::vector<std::set<Index>> expected(mesh.nodes.size());
  for (const QuadraticTet& element : mesh.elements)
  {
    for (const Index node : element)
    {
      expected[node].insert(element.begin(), element.end());
    }
  }
  for (Index node = 0; node < rows.size(); ++node)
  {
    expected[node].erase(node);
    EXPECT_EQ(std::vector<Index>(expected[node].begin(), expected[node].end()),
              std::vector<Index>(rows.begin(node), rows.end(node)));
  }
}

}  // namespace
}  // namespace soft_tissue
