#include "soft_tissue_sim/collision/box_selection.h"

#include <gtest/gtest.h>

#include <set>

#include "support/contact_scene.h"

namespace soft_tissue::test
{
template <std::size_t K>
bool touches(const std::array<Index, K>& element, const Points& x, const Box3& box)
{
  Box3 own;
  for (const Index node : element)
  {
    own.extend(x[node]);
  }
  return own.overlaps(box);
}

TEST(BoxSelection, IsWhatABoxTestOfEachElementFinds)
{
  const TetMesh mesh = slab({0, 0, 0}, {1, 1, 1}, 4, 4, 4);
  const BoundarySurface surface = extractBoundary(Index(mesh.nodes.size()), mesh.tets);
  const Points x = shaken(mesh.nodes, 0.05, 3);
  RandomGeometry random(4);
  BoxSelection selection;
  for (int i = 0; i < 50; ++i)
  {
    Box3 box;
    box.extend(random.point(1.2));
    box.extend(random.point(1.2));
    selection.select(x, mesh.tets, surface, box);
    std::vector<Index> tets;
    std::set<Index> nodes;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    {
      if (touches(mesh.tets[t], x, box))
      {
        tets.push_back(Index(t));
        nodes.insert(mesh.tets[t].begin(), mesh.tets[t].end());
      }
    }
    std::vector<Index> edges;
    for (std::size_t e = 0; e < surface.edges.size(); ++e)
    {
      if (touches(surface.edges[e], x, box))
      {
        edges.push_back(Index(e));
      }
    }
    std::vector<Index> points;
    for (const Index node : surface.nodes)
    {
      if (box.contains(x[node]))
      {
        points.push_back(node);
      }
    }
    EXPECT_EQ(selection.tets(), tets);
    EXPECT_EQ(selection.tetNodes(), std::vector<Index>(nodes.begin(), nodes.end()));
    EXPECT_EQ(selection.surfaceEdges(), edges);
    EXPECT_EQ(selection.surfaceNodes(), points);
    EXPECT_EQ(selection.empty(), tets.empty() && edges.empty());
  }
}

}  // namespace soft_tissue::test
