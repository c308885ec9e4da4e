#include "soft_tissue_sim/mesh/check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
/** Corners of a cube of edge 2: a regular tet has edges of 2 sqrt(2). */
TetMesh regularTet()
{
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 3, 2}}, {0}};
}

TEST(CheckMesh, regularTetHasQualityOneAndItsKnownAngle)
{
  const MeshCheck check = checkMesh(regularTet());
  EXPECT_NEAR(check.min_quality, 1.0, 1e-14);
  EXPECT_NEAR(check.volume_m3, 8.0 / 3.0, 1e-14);
  const double angle = std::acos(1.0 / 3.0) * 180.0 / M_PI;
  EXPECT_NEAR(check.min_dihedral_deg, angle, 1e-9);
  EXPECT_NEAR(check.max_dihedral_deg, angle, 1e-9);
  EXPECT_EQ(check.size_m, Vec3(2, 2, 2));
  EXPECT_EQ(check.slivers + check.inverted + check.degenerate, 0U);
}

TEST(CheckMesh, qualityKnowsNoSizeAndNoPlace)
{
  const auto [nodes, tets, tags] = test::unitTet();
  const double quality = tetQuality(nodes[0], nodes[1], nodes[2], nodes[3]);
  // edges 1, 1, 1 and sqrt(2) three times: mean square 3/2
  EXPECT_NEAR(quality, std::sqrt(2.0) / std::pow(1.5, 1.5), 1e-14);
  const auto moved = [](const Vec3& p) { return Vec3(1e-3 * p + Vec3(0.25, -0.5, 0.125)); };
  EXPECT_NEAR(tetQuality(moved(nodes[0]), moved(nodes[1]), moved(nodes[2]), moved(nodes[3])),
              quality, 1e-12);
}

TEST(CheckMesh, countsInvertedDegenerateAndSliverTets)
{
  TetMesh mesh = test::unitTet();
  mesh.nodes.push_back({0.25, 0.25, 0.0});    // in the plane of nodes 0, 1, 2
  mesh.nodes.push_back({0.25, 0.25, 0.001});  // just above it
  mesh.tets = {{0, 2, 1, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}};
  mesh.tags = {0, 0, 0};
  const MeshCheck check = checkMesh(mesh);
  EXPECT_EQ(check.inverted, 1U);
  EXPECT_EQ(check.degenerate, 1U);
  EXPECT_EQ(check.slivers, 3U);
  EXPECT_LT(check.min_quality, 0.0);
}

TEST(CheckMesh, tetThatIsFlatOnlyByRoundingIsDegenerate)
{
  TetMesh mesh = test::unitTet();
  mesh.nodes[3] = {0.3, 0.3, 0.0};
  for (Vec3& node : mesh.nodes)
  {
    node = 1e-3 * (node + Vec3(100.1, 200.2, 300.3));
  }
  EXPECT_EQ(checkMesh(mesh).degenerate, 1U);
}

TEST(CheckMesh, countsDuplicatesOrphansAndTags)
{
  TetMesh mesh = test::twoTets();
  mesh.nodes.push_back(mesh.nodes[2]);
  mesh.nodes.push_back({9, 9, 9});
  mesh.tets.push_back({3, 2, 1, 0});
  mesh.tags.push_back(2);
  const MeshCheck check = checkMesh(mesh);
  EXPECT_EQ(check.duplicate_nodes, 1U);
  EXPECT_EQ(check.orphan_nodes, 2U);
  EXPECT_EQ(check.duplicate_tets, 1U);
  EXPECT_EQ(check.overshared_faces, 1U);
  EXPECT_EQ(check.tags, (std::map<int, std::size_t>{{1, 1}, {2, 2}}));
}

TEST(CheckMesh, tetsThatShareLessThanAFacePinchTheBoundary)
{
  const Points nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},   {0, 0, 1},
                        {2, 0, 0}, {2, 1, 0}, {2, 0, 1.0}, {-1, 0, 0}};
  const MeshCheck at_node = checkMesh({nodes, {{0, 1, 2, 3}, {1, 4, 5, 6}}, {0, 0}});
  EXPECT_EQ(at_node.parts, 2U);
  EXPECT_EQ(at_node.boundary.parts, 1U);
  EXPECT_EQ(at_node.boundary.non_manifold_vertices, 1U);
  EXPECT_EQ(at_node.boundary.non_manifold_edges, 0U);
  const MeshCheck at_edge = checkMesh({nodes, {{0, 1, 2, 3}, {0, 1, 5, 4}}, {0, 0}});
  EXPECT_EQ(at_edge.parts, 2U);
  EXPECT_EQ(at_edge.boundary.non_manifold_edges, 1U);
}

TEST(CheckMesh, emptyMeshIsAllZero)
{
  const MeshCheck check = checkMesh({});
  EXPECT_EQ(check.tets + check.nodes + check.parts + check.boundary_triangles, 0U);
}

TEST(CheckSurface, closedOutwardSurfaceBoundsItsVolume)
{
  const SurfaceCheck check = checkSurface(test::unitTetSurface());
  EXPECT_TRUE(check.watertight());
  EXPECT_NEAR(check.volume_m3, 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(check.area_m2, 1.5 + std::sqrt(3.0) / 2.0, 1e-14);
  EXPECT_EQ(check.topology.parts, 1U);
}

TEST(CheckSurface, seesHolesFlipsAndInsideOut)
{
  TriMesh open = test::unitTetSurface();
  open.triangles.pop_back();
  EXPECT_EQ(checkSurface(open).topology.open_edges, 3U);
  EXPECT_FALSE(checkSurface(open).watertight());

  TriMesh flipped = test::unitTetSurface();
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_EQ(checkSurface(flipped).topology.flipped_edges, 3U);
  EXPECT_FALSE(checkSurface(flipped).watertight());

  TriMesh inside_out = test::unitTetSurface();
  for (Triangle& triangle : inside_out.triangles)
  {
    std::swap(triangle[0], triangle[1]);
  }
  EXPECT_LT(checkSurface(inside_out).volume_m3, 0.0);
  EXPECT_FALSE(checkSurface(inside_out).watertight());
}

TEST(CheckSurface, countsZeroAreaDuplicateAndNonManifold)
{
  TriMesh mesh = test::unitTetSurface();
  mesh.nodes.push_back({0.5, 0, 0});
  mesh.nodes.push_back({0, 0, -1});
  mesh.triangles.push_back({0, 4, 1});  // its nodes lie on a line
  mesh.triangles.push_back({0, 1, 1});  // a node twice
  mesh.triangles.push_back(mesh.triangles[0]);
  mesh.triangles.push_back({0, 1, 5});  // a third triangle at the edge (0, 1)
  const SurfaceCheck check = checkSurface(mesh);
  EXPECT_EQ(check.zero_area, 2U);
  EXPECT_EQ(check.duplicate_triangles, 1U);
  EXPECT_EQ(check.topology.non_manifold_edges, 4U);
  EXPECT_FALSE(check.watertight());
}

TEST(CheckReport, marksTroubleAndOnlyTrouble)
{
  const std::string good = toText(checkMesh(regularTet()));
  EXPECT_EQ(good.find('!'), std::string::npos) << good;
  EXPECT_NE(good.find("volume:                  2.66667 m^3"), std::string::npos) << good;
  TriMesh open = test::unitTetSurface();
  open.triangles.pop_back();
  const std::string bad = toText(checkSurface(open));
  EXPECT_NE(bad.find("! open edges:              3"), std::string::npos) << bad;
  EXPECT_NE(bad.find("bounds a volume:         no"), std::string::npos) << bad;
}
}  // namespace
}  // namespace soft_tissue
