#include "soft_tissue_sim/mesh/repair.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
using Sentences = std::vector<std::string>;

/** The surface with its triangles between outer nodes, each with corners of its own, scaled. */
void addCopy(const TriMesh& part, double scale, const Vec3& shift, bool inside_out, TriMesh& mesh)
{
  const auto base = static_cast<Index>(mesh.nodes.size());
  for (const Vec3& node : part.nodes)
  {
    mesh.nodes.push_back(scale * node + shift);
  }
  for (const Triangle& t : part.triangles)
  {
    mesh.triangles.push_back(inside_out ? Triangle{base + t[0], base + t[2], base + t[1]}
                                        : Triangle{base + t[0], base + t[1], base + t[2]});
  }
}

TEST(RepairMesh, soundMeshIsLeftAlone)
{
  TetMesh mesh = test::twoTets();
  const RepairReport report = repairMesh(mesh);
  EXPECT_TRUE(report.done.empty());
  EXPECT_TRUE(report.left.empty());
  EXPECT_EQ(mesh.nodes, test::twoTets().nodes);
  EXPECT_EQ(mesh.tets, test::twoTets().tets);
  EXPECT_EQ(mesh.tags, test::twoTets().tags);
}

TEST(RepairMesh, mendsEachFaultAndSaysSo)
{
  TetMesh mesh = test::twoTets();
  mesh.nodes.push_back(mesh.nodes[3]);  // node 5: a second node 3
  mesh.nodes.push_back({8, 8, 8});      // node 6: in no tet
  mesh.nodes.push_back({0.5, 0.5, 0});  // node 7: in the plane of 0, 1, 2
  mesh.tets[1] = {2, 1, 5, 4};          // left handed, and with the second node 3
  mesh.tets.push_back({0, 2, 3, 1});    // the first tet again
  mesh.tets.push_back({0, 1, 2, 7});    // flat
  mesh.tags = {1, 2, 3, 4};
  const RepairReport report = repairMesh(mesh);
  EXPECT_EQ(report.done, (Sentences{"1 nodes at the place of an earlier one merged with it",
                                    "1 tets without volume dropped", "1 duplicate tets dropped",
                                    "1 left-handed tets turned", "2 nodes in no tet dropped"}));
  EXPECT_TRUE(report.left.empty());
  const MeshCheck check = checkMesh(mesh);
  EXPECT_EQ(check.nodes, 5U);
  EXPECT_EQ(check.tets, 2U);
  EXPECT_EQ(check.parts, 1U);
  EXPECT_NEAR(check.volume_m3, 0.5, 1e-15);
  EXPECT_EQ(mesh.tags, (std::vector<int>{1, 2}));
}

TEST(RepairMesh, saysWhatItCouldNotMend)
{
  TetMesh mesh = test::unitTet();
  mesh.nodes.push_back({2, 0, 0});
  mesh.nodes.push_back({2, 1, 0});
  mesh.nodes.push_back({2, 0, 0.001});
  mesh.tets.push_back({1, 4, 5, 6});
  mesh.tags.push_back(0);
  const RepairReport report = repairMesh(mesh);
  EXPECT_EQ(report.left, (Sentences{"1 slivers (q < 0.1)",
                                    "1 parts beside the first, connected to it by no face",
                                    "1 non-manifold vertices on the boundary"}));
}

TEST(RepairMesh, meshWithoutASoundTetIsRefused)
{
  TetMesh mesh = test::unitTet();
  mesh.nodes[3] = {0.2, 0.2, 0};
  EXPECT_THROW(repairMesh(mesh), Error);
}

TEST(RepairSurface, randomlyTurnedTrianglesPointOutwardAgain)
{
  for (unsigned seed = 0; seed < 16; ++seed)
  {
    TriMesh mesh = test::unitTetSurface();
    std::mt19937 random(seed);
    for (Triangle& triangle : mesh.triangles)
    {
      if (random() % 2 == 0)
      {
        std::swap(triangle[0], triangle[1]);
      }
    }
    repairSurface(mesh);
    EXPECT_TRUE(checkSurface(mesh).watertight());
  }
}

TEST(RepairSurface, nestedShellsPointOutOfTheSolid)
{
  TriMesh mesh;  // a solid, a cavity in it, a solid in the cavity; and a solid beside, all wrong
  addCopy(test::unitTetSurface(), 10.0, Vec3::Zero(), true, mesh);
  addCopy(test::unitTetSurface(), 2.0, Vec3(1, 1, 1), false, mesh);
  addCopy(test::unitTetSurface(), 0.5, Vec3(1.2, 1.2, 1.2), true, mesh);
  addCopy(test::unitTetSurface(), 3.0, Vec3(20, 0, 0), true, mesh);
  const RepairReport report = repairSurface(mesh);
  EXPECT_EQ(report.done, Sentences{"16 triangles turned"});
  EXPECT_NEAR(checkSurface(mesh).volume_m3, (1000.0 - 8.0 + 0.125 + 27.0) / 6.0, 1e-10);
}

TEST(RepairSurface, mendsEachFaultAndSaysSo)
{
  TriMesh mesh = test::unitTetSurface();
  mesh.nodes.push_back(mesh.nodes[2]);
  mesh.nodes.push_back({5, 5, 5});
  mesh.triangles[0] = {1, 4, 3};
  mesh.triangles.push_back({3, 2, 0});
  mesh.triangles.push_back({1, 1, 2});
  const RepairReport report = repairSurface(mesh);
  EXPECT_EQ(report.done,
            (Sentences{"1 nodes at the place of an earlier one merged with it",
                       "1 triangles without area dropped", "1 duplicate triangles dropped",
                       "1 nodes in no triangle dropped"}));
  EXPECT_TRUE(report.left.empty());
  EXPECT_TRUE(checkSurface(mesh).watertight());
}

TEST(RepairSurface, saysWhatItCouldNotMend)
{
  TriMesh mesh = test::unitTetSurface();
  mesh.triangles.pop_back();
  EXPECT_EQ(repairSurface(mesh).left, Sentences{"3 open edges"});
  TriMesh flat = {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}};
  EXPECT_THROW(repairSurface(flat), Error);
}

TEST(RepairSurface, realInsideOutLiverIsTurned)
{
  const char* folder = std::getenv("SOFT_TISSUE_DATA");
  if (folder == nullptr)
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  TriMesh liver = loadTriMesh(std::string(folder) + "/hard/liver.vtk", 1e-3).mesh;
  const double volume_m3 = checkSurface(liver).volume_m3;
  EXPECT_EQ(repairSurface(liver).done, Sentences{"10000 triangles turned"});
  EXPECT_TRUE(checkSurface(liver).watertight());
  EXPECT_NEAR(checkSurface(liver).volume_m3, -volume_m3, 1e-12);

  TriMesh broken = loadTriMesh(std::string(folder) + "/hard/liver_collision.stl", 1e-3).mesh;
  const RepairReport report = repairSurface(broken);
  EXPECT_FALSE(report.left.empty());
  EXPECT_FALSE(checkSurface(broken).watertight());
}
}  // namespace
}  // namespace soft_tissue
