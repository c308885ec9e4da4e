#include "soft_tissue_sim/mesh/generate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "support/mesh_files.h"

namespace soft_tissue
{
namespace
{
/** What every generated mesh must be: one closed, manifold part of right-handed tets in good shape.
 */
void expectSound(const TetMesh& mesh, double min_quality)
{
  const MeshCheck check = checkMesh(mesh);
  EXPECT_GE(check.min_quality, min_quality);
  EXPECT_EQ(check.inverted + check.degenerate + check.slivers, 0U);
  EXPECT_EQ(check.duplicate_nodes + check.orphan_nodes + check.duplicate_tets, 0U);
  EXPECT_EQ(check.overshared_faces, 0U);
  EXPECT_EQ(check.parts, 1U);
  EXPECT_EQ(check.boundary.parts, 1U);
  EXPECT_EQ(check.boundary.open_edges + check.boundary.flipped_edges, 0U);
  EXPECT_EQ(check.boundary.non_manifold_edges + check.boundary.non_manifold_vertices, 0U);
}

/** Euler characteristic of the boundary: 2 for a ball, 0 for a torus. */
long boundaryEuler(const TetMesh& mesh)
{
  const BoundarySurface boundary =
      extractBoundary(static_cast<Index>(mesh.nodes.size()), mesh.tets);
  return static_cast<long>(boundary.nodes.size()) - static_cast<long>(boundary.edges.size()) +
         static_cast<long>(boundary.triangles.size());
}

double taggedVolume(const TetMesh& mesh, int tag)
{
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    const Tet& tet = mesh.tets[t];
    const Points& x = mesh.nodes;
    volume +=
        mesh.tags[t] == tag ? signedVolume6(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]) / 6.0 : 0.0;
  }
  return volume;
}

std::string fileText(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(MakeBox, fillsItsBoxWithSixTetsACell)
{
  const TetMesh box = makeBox({3, 2, 4}, Vec3(0.3, 0.1, 0.2));
  expectSound(box, 0.3);
  EXPECT_EQ(box.nodes.size(), 4U * 3U * 5U);
  EXPECT_EQ(box.tets.size(), 6U * 24U);
  const MeshCheck check = checkMesh(box);
  EXPECT_NEAR(check.volume_m3, 0.006, 1e-15);
  EXPECT_EQ(check.size_m, Vec3(0.3, 0.1, 0.2));
  EXPECT_EQ(check.boundary_triangles, 2U * 2U * (3U * 2U + 3U * 4U + 2U * 4U));
  EXPECT_EQ(boundaryEuler(box), 2);
}

TEST(MakeBox, cellsComeNearTheNumberOfTetsAskedFor)
{
  const std::array<int, 3> cells = cellsForBox(Vec3(0.1, 0.02, 0.02), 5000);
  EXPECT_NEAR(6.0 * cells[0] * cells[1] * cells[2], 5000.0, 500.0);
  EXPECT_THROW(cellsForBox(Vec3(0.1, 0.0, 0.02), 5000), Error);
  EXPECT_THROW(cellsForBox(Vec3(0.1, 0.1, 0.02), 5), Error);
}

TEST(MakeBall, boundaryNodesLieOnTheSphere)
{
  const TetMesh ball = makeBall(0.05, 5000);
  expectSound(ball, 0.4);
  EXPECT_NEAR(static_cast<double>(ball.tets.size()), 5000.0, 500.0);
  EXPECT_EQ(boundaryEuler(ball), 2);
  for (const Index node : extractBoundary(static_cast<Index>(ball.nodes.size()), ball.tets).nodes)
  {
    EXPECT_NEAR(ball.nodes[node].norm(), 0.05, 1e-9);
  }
}

TEST(MakeBall, volumeConvergesQuadratically)
{
  const double exact = 4.0 / 3.0 * M_PI * std::pow(0.05, 3);
  const double coarse = exact - checkMesh(makeBall(0.05, 2500)).volume_m3;
  const double fine = exact - checkMesh(makeBall(0.05, 20000)).volume_m3;
  EXPECT_GT(fine, 0.0);
  EXPECT_LT(fine, coarse / 3.0);  // half the edge length: a quarter of the gap, and some scatter
}

TEST(MakeTorus, hasOneHandle)
{
  const TetMesh torus = makeTorus(0.05, 0.02, 5000);
  expectSound(torus, 0.4);
  EXPECT_EQ(boundaryEuler(torus), 0);
  const double exact = 2.0 * M_PI * M_PI * 0.05 * 0.02 * 0.02;
  EXPECT_NEAR(checkMesh(torus).volume_m3, exact, 0.04 * exact);
}

TEST(MakeTube, isOpenAtBothEnds)
{
  const TetMesh tube = makeTube(0.01, 0.015, 0.1, 5000);
  expectSound(tube, 0.2);
  EXPECT_NEAR(static_cast<double>(tube.tets.size()), 5000.0, 500.0);
  EXPECT_EQ(boundaryEuler(tube), 0);
  const double exact = M_PI * (0.015 * 0.015 - 0.01 * 0.01) * 0.1;
  EXPECT_NEAR(checkMesh(tube).volume_m3, exact, 0.03 * exact);
}

class Lobe : public testing::TestWithParam<std::pair<const char*, std::size_t>>
{};

TEST_P(Lobe, isSoundAndOfTheSizeAskedFor)
{
  const double tets = static_cast<double>(GetParam().second);
  const TetMesh lobe = makeLobe(GetParam().second);
  expectSound(lobe, 0.35);
  EXPECT_NEAR(static_cast<double>(lobe.tets.size()), tets, 0.1 * tets);
  EXPECT_EQ(boundaryEuler(lobe), 2);
  const MeshCheck check = checkMesh(lobe);
  EXPECT_NEAR(check.size_m.x(), 0.10, 0.005);
  EXPECT_NEAR(check.size_m.y(), 0.08, 0.005);
  EXPECT_NEAR(check.size_m.z(), 0.04, 0.005);
}

TEST_P(Lobe, standsOnItsFlatBottom)
{
  const TetMesh lobe = makeLobe(GetParam().second);
  double bottom_area_m2 = 0.0;
  for (const Triangle& t :
       extractBoundary(static_cast<Index>(lobe.nodes.size()), lobe.tets).triangles)
  {
    const Vec3 normal =
        (lobe.nodes[t[1]] - lobe.nodes[t[0]]).cross(lobe.nodes[t[2]] - lobe.nodes[t[0]]);
    const bool flat =
        lobe.nodes[t[0]].z() == 0.0 && lobe.nodes[t[1]].z() == 0.0 && lobe.nodes[t[2]].z() == 0.0;
    bottom_area_m2 += flat ? 0.5 * normal.norm() : 0.0;
    EXPECT_TRUE(!flat || normal.z() < 0.0);
  }
  EXPECT_GT(bottom_area_m2, 0.8 * M_PI * 0.05 * 0.04);
  for (const Vec3& node : lobe.nodes)
  {
    EXPECT_TRUE(node.z() == 0.0 || node.z() > 1e-3);  // a box below 1 mm holds the bottom alone
  }
}

TEST_P(Lobe, noduleIsABallInsideBoundedByTets)
{
  const TetMesh lobe = makeLobe(GetParam().second);
  const double ball_m3 = 4.0 / 3.0 * M_PI * std::pow(0.009, 3);
  const double nodule_m3 = taggedVolume(lobe, kNoduleTag);
  EXPECT_LT(nodule_m3, ball_m3);
  EXPECT_GT(nodule_m3, 0.5 * ball_m3);
  TetMesh nodule = lobe;
  nodule.tets.clear();
  nodule.tags.clear();
  for (std::size_t t = 0; t < lobe.tets.size(); ++t)
  {
    if (lobe.tags[t] == kNoduleTag)
    {
      nodule.tets.push_back(lobe.tets[t]);
      nodule.tags.push_back(kNoduleTag);
    }
  }
  EXPECT_EQ(boundaryEuler(nodule), 2);
  const auto node_count = static_cast<Index>(lobe.nodes.size());
  const BoundarySurface skin = extractBoundary(node_count, lobe.tets);
  const BoundarySurface interface = extractBoundary(node_count, nodule.tets);
  const Vec3 centre(-0.012, 0.006, 0.0263);
  for (const Index node : interface.nodes)
  {
    EXPECT_EQ(skin.node_slot[node], -1);
    EXPECT_NEAR((lobe.nodes[node] - centre).norm(), 0.009, 1e-9);
  }
}

TEST_P(Lobe, shippedFileIsWhatTheGeneratorMakes)
{
  const test::ScratchFolder folder;
  saveGmsh(folder.path("lobe.msh"), makeLobe(GetParam().second), 7);
  const std::string shipped = std::string(SOURCE_DIR) + "/config/meshes/" + GetParam().first;
  EXPECT_TRUE(fileText(folder.path("lobe.msh")) == fileText(shipped)) << shipped;
  const TetMesh made = makeLobe(GetParam().second);
  const TetMesh loaded = loadTetMesh(shipped, 1.0).mesh;
  EXPECT_EQ(loaded.tets, made.tets);
  EXPECT_EQ(loaded.tags, made.tags);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Lobe,
                         testing::Values(std::make_pair("lobe_1k.msh", std::size_t{1000}),
                                         std::make_pair("lobe_5k.msh", std::size_t{5000}),
                                         std::make_pair("lobe_20k.msh", std::size_t{20000})));

TEST(Generate, sheetsCoverTheirRectangleOnce)
{
  for (const SheetPattern pattern : {SheetPattern::diagonal, SheetPattern::alternating,
                                     SheetPattern::crossed, SheetPattern::irregular})
  {
    const TriMesh mesh = makeSheet({7, 4}, {0.3, 0.2}, pattern);
    EXPECT_EQ(mesh.triangles.size(), pattern == SheetPattern::crossed ? 112U : 56U);
    double area = 0.0;
    for (const Triangle& t : mesh.triangles)
    {
      const Vec3& a = mesh.nodes[t[0]];
      const double twice = (mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).z();
      EXPECT_GT(twice, 0.1 * 0.06 / 28.0);  // of a cell
      area += 0.5 * twice;
    }
    EXPECT_NEAR(area, 0.06, 1e-15);
    // All positive with this sum, and a rim of one edge a cell: nothing overlaps, nothing is
    // missing.
    EXPECT_EQ(extractPlanarBoundary(static_cast<Index>(mesh.nodes.size()), mesh.triangles)
                  .triangles.size(),
              22U);
  }
}

TEST(Generate, refusesSizesThatMakeNoShape)
{
  EXPECT_THROW(makeBox({0, 1, 1}, Vec3(1, 1, 1)), Error);
  EXPECT_THROW(makeBox({1, 1, 1}, Vec3(1, -1, 1)), Error);
  EXPECT_THROW(makeBall(0.0, 1000), Error);
  EXPECT_THROW(makeBall(0.0 / 0.0, 1000), Error);
  EXPECT_THROW(makeBall(0.05, 10), Error);
  EXPECT_THROW(makeTorus(0.02, 0.05, 1000), Error);
  EXPECT_THROW(makeTube(0.02, 0.01, 0.1, 1000), Error);
  EXPECT_THROW(makeTube(0.01, 0.02, 0.0, 1000), Error);
  EXPECT_THROW(makeLobe(100), Error);
  EXPECT_THROW(makeSheet({0, 1}, {1.0, 1.0}, SheetPattern::diagonal), Error);
  EXPECT_THROW(makeSheet({1, 1}, {1.0, 0.0}, SheetPattern::diagonal), Error);
}
}  // namespace
}  // namespace soft_tissue
