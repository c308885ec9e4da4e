#include "soft_tissue_sim/mesh/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "soft_tissue_sim/mesh/grouping.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
constexpr Index kNodes = 14;

/** Slow oracle: tets around each face, by a map over sorted node triples. */
std::map<std::set<Index>, std::vector<Index>> tetsOfFaces(const std::vector<Tet>& tets)
{
  std::map<std::set<Index>, std::vector<Index>> faces;
  for (std::size_t t = 0; t < tets.size(); ++t)
  {
    for (int k = 0; k < 4; ++k)
    {
      std::set<Index> face(tets[t].begin(), tets[t].end());
      face.erase(tets[t][k]);
      faces[face].push_back(static_cast<Index>(t));
    }
  }
  return faces;
}

bool contains(const Tet& tet, Index node)
{
  return std::find(tet.begin(), tet.end(), node) != tet.end();
}

class RandomTopology : public testing::TestWithParam<unsigned>
{
 protected:
  std::vector<Tet> tets_ = test::randomTets(kNodes, 40, GetParam());
};

TEST_P(RandomTopology, nodeRowsMatchDefinition)
{
  const Adjacency around = nodeTets(kNodes, tets_);
  const Adjacency neighbours = nodeNeighbours(kNodes, tets_);
  ASSERT_EQ(around.size(), kNodes);
  ASSERT_EQ(neighbours.size(), kNodes);
  for (Index node = 0; node < kNodes; ++node)
  {
    std::vector<Index> expected_tets;
    std::set<Index> expected_nodes;
    for (std::size_t t = 0; t < tets_.size(); ++t)
    {
      if (contains(tets_[t], node))
      {
        expected_tets.push_back(static_cast<Index>(t));
        expected_nodes.insert(tets_[t].begin(), tets_[t].end());
      }
    }
    expected_nodes.erase(node);
    EXPECT_EQ(std::vector<Index>(around.begin(node), around.end(node)), expected_tets);
    EXPECT_EQ(std::vector<Index>(neighbours.begin(node), neighbours.end(node)),
              std::vector<Index>(expected_nodes.begin(), expected_nodes.end()));
  }
}

TEST_P(RandomTopology, boundaryHoldsExactlyTheSingleFaces)
{
  const auto faces = tetsOfFaces(tets_);
  const BoundarySurface boundary = extractBoundary(kNodes, tets_);
  std::size_t expected_count = 0;
  for (const auto& [face, sharing] : faces)
  {
    expected_count += sharing.size() == 1;
  }
  ASSERT_EQ(boundary.triangles.size(), expected_count);
  std::set<std::set<Index>> seen;
  std::set<Index> boundary_nodes;
  for (std::size_t i = 0; i < boundary.triangles.size(); ++i)
  {
    const std::set<Index> face(boundary.triangles[i].begin(), boundary.triangles[i].end());
    EXPECT_EQ(faces.at(face), std::vector<Index>{boundary.triangle_tet[i]});
    EXPECT_TRUE(seen.insert(face).second);
    boundary_nodes.insert(face.begin(), face.end());
  }
  EXPECT_EQ(boundary.nodes, std::vector<Index>(boundary_nodes.begin(), boundary_nodes.end()));
  for (Index node = 0; node < kNodes; ++node)
  {
    const auto place = std::find(boundary.nodes.begin(), boundary.nodes.end(), node);
    EXPECT_EQ(boundary.node_slot[node],
              place == boundary.nodes.end() ? -1 : place - boundary.nodes.begin());
  }
}

TEST_P(RandomTopology, boundaryEdgesAndNeighboursMatchDefinition)
{
  const BoundarySurface boundary = extractBoundary(kNodes, tets_);
  std::map<Edge, std::vector<Index>> edges;
  for (std::size_t i = 0; i < boundary.triangles.size(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      edges[sortedKey(Edge{boundary.triangles[i][k], boundary.triangles[i][(k + 1) % 3]})]
          .push_back(static_cast<Index>(i));
    }
  }
  ASSERT_EQ(boundary.edges.size(), edges.size());
  EXPECT_TRUE(std::is_sorted(boundary.edges.begin(), boundary.edges.end()));
  for (std::size_t i = 0; i < boundary.triangles.size(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Edge edge =
          sortedKey(Edge{boundary.triangles[i][k], boundary.triangles[i][(k + 1) % 3]});
      EXPECT_EQ(boundary.edges[boundary.triangle_edges[i][k]], edge);
      const std::vector<Index>& sharing = edges.at(edge);
      EXPECT_EQ(boundary.triangle_neighbours[i][k],
                sharing.size() == 2 ? sharing[0] + sharing[1] - static_cast<Index>(i) : -1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomTopology, testing::Values(1U, 2U, 3U, 4U));

TEST(Topology, boundaryTrianglesPointOutwards)
{
  const TetMesh mesh = test::twoTets();
  const BoundarySurface boundary = extractBoundary(5, mesh.tets);
  ASSERT_EQ(boundary.triangles.size(), 6U);
  double volume6 = 0.0;
  for (const Triangle& triangle : boundary.triangles)
  {
    volume6 += signedVolume6(Vec3::Zero(), mesh.nodes[triangle[0]], mesh.nodes[triangle[1]],
                             mesh.nodes[triangle[2]]);
  }
  EXPECT_DOUBLE_EQ(volume6, 1.0 + 2.0);  // both tets, by the divergence theorem
}

TEST(Topology, faceSharedByThreeTetsIsNoBoundary)
{
  const std::vector<Tet> tets = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}};
  EXPECT_EQ(extractBoundary(6, tets).triangles.size(), 9U);
}

TEST(Topology, thePlaneHasEdgesForABoundary)
{
  // Two triangles side by side: four edges outside, one between them.
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
  const BoundarySurface boundary = extractPlanarBoundary(5, triangles);
  EXPECT_EQ(boundary.triangles,
            std::vector<Triangle>({{0, 1, 1}, {1, 2, 2}, {2, 3, 3}, {3, 0, 0}}));
  EXPECT_EQ(boundary.triangle_tet, std::vector<Index>({0, 0, 1, 1}));
  EXPECT_EQ(boundary.nodes, std::vector<Index>({0, 1, 2, 3}));
  EXPECT_EQ(boundary.node_slot[4], -1);
  EXPECT_EQ(std::vector<Index>(boundary.node_triangles.begin(2), boundary.node_triangles.end(2)),
            std::vector<Index>({1, 2}));
  const Adjacency neighbours = nodeNeighbours(5, triangles);
  EXPECT_EQ(std::vector<Index>(neighbours.begin(0), neighbours.end(0)),
            std::vector<Index>({1, 2, 3}));
  EXPECT_EQ(std::vector<Index>(neighbours.begin(1), neighbours.end(1)), std::vector<Index>({0, 2}));
}

TEST(Topology, emptyMeshGivesEmptyRows)
{
  EXPECT_EQ(nodeTets(3, {}).size(), 3);
  EXPECT_EQ(nodeNeighbours(3, std::vector<Tet>()).items.size(), 0U);
  EXPECT_TRUE(extractBoundary(3, {}).triangles.empty());
}
}  // namespace
}  // namespace soft_tissue
