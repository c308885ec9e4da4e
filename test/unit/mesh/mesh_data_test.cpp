#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <set>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"
#include "soft_tissue_sim/mesh/mesh_io.h"

namespace soft_tissue
{
namespace
{
namespace fs = std::filesystem;

std::string dataFolder()
{
  const char* folder = std::getenv("SOFT_TISSUE_DATA");
  return folder == nullptr ? "" : folder;
}

/** What independent tools found in a volume file. */
struct VolumeFacts
{
  const char* file;
  const char* format;
  std::size_t nodes;
  std::size_t tets;
  std::size_t ignored;
  std::size_t turned;
  std::size_t slivers;
  std::size_t boundary_triangles;
  std::size_t pinched_vertices;
  std::size_t orphans;
};
void PrintTo(const VolumeFacts& facts, std::ostream* out)
{
  *out << facts.file;
}

const VolumeFacts kVolumes[] = {
    {"tissue/gallbladder_volumetric.vtk", "vtk 4.2 binary UNSTRUCTURED_GRID", 367, 1063, 1456, 0,
     90, 728, 0, 1},
    {"tissue/liver_gmsh1.msh", "gmsh 1 ascii", 181, 596, 0, 0, 2, 276, 0, 0},
    {"tissue/liver_volumetric.vtk", "vtk 4.2 binary UNSTRUCTURED_GRID", 98, 273, 376, 0, 11, 186, 0,
     0},
    {"tissue/tissue_volume.msh", "gmsh 2.2 ascii", 493, 1432, 892, 0, 0, 892, 0, 0},
    {"tissue/tissue_volumetric.msh", "gmsh 2.2 ascii", 145, 348, 388, 0, 0, 280, 0, 0},
    {"tissue/wound_deformable.ply", "ply ascii", 391, 1476, 407, 0, 0, 540, 0, 0},
    {"hard/6_tetra_bad.msh", "gmsh 2.2 ascii", 17, 6, 0, 1, 0, 24, 5, 0},
    {"hard/Bunny.vtk", "vtu ascii", 1911, 5897, 0, 0, 118, 3806, 2, 0},
    {"hard/HumanHeartHull.node", "tetgen ascii", 395, 1679, 0, 0, 1268, 786, 0, 0},
    {"hard/HumanHeartHull.ele", "tetgen ascii", 395, 1679, 0, 0, 1268, 786, 0, 0},
    {"hard/c_extruded_refined.msh", "gmsh 2.2 ascii", 667, 2320, 960, 0, 409, 960, 0, 0},
    {"hard/muscle.1.node", "tetgen ascii", 65, 150, 0, 0, 38, 120, 0, 0},
    {"hard/muscle.1.ele", "tetgen ascii", 65, 150, 0, 0, 38, 120, 0, 0},
    {"hard/organic_shape.msh", "gmsh 2.1 ascii", 359, 1184, 600, 0, 61, 600, 0, 0},
    {"hard/wayne_quad.1.node", "tetgen ascii", 26, 47, 0, 0, 1, 48, 0, 0},
    {"hard/wayne_quad.1.ele", "tetgen ascii", 26, 47, 0, 0, 1, 48, 0, 0},
    {"beams/beam1k.msh", "gmsh 2.2 ascii", 308, 906, 0, 0, 0, 0, 0, 0},
    {"beams/beam5k.msh", "gmsh 2.2 ascii", 1321, 5016, 0, 0, 0, 0, 0, 0},
    {"beams/beam20k.msh", "gmsh 2.2 ascii", 4470, 19920, 0, 0, 0, 0, 0, 0},
    {"beams/ball5k.msh", "gmsh 2.2 ascii", 1143, 4960, 0, 0, 0, 0, 0, 0},
    {"beams/ball50k.msh", "gmsh 2.2 ascii", 9357, 49238, 0, 0, 0, 0, 0, 0},
};

class RealVolume : public testing::TestWithParam<VolumeFacts>
{};

TEST_P(RealVolume, loadsWithATrueReport)
{
  if (dataFolder().empty())
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  const VolumeFacts& facts = GetParam();
  const LoadedTetMesh loaded = loadTetMesh(dataFolder() + "/" + facts.file, 1e-3);
  EXPECT_EQ(loaded.report.format, facts.format);
  EXPECT_EQ(loaded.report.reoriented_tets, facts.turned);
  EXPECT_EQ(loaded.report.ignored_elements, facts.ignored);
  const MeshCheck check = checkMesh(loaded.mesh);
  EXPECT_EQ(check.nodes, facts.nodes);
  EXPECT_EQ(check.tets, facts.tets);
  EXPECT_EQ(check.inverted, 0U);
  EXPECT_EQ(check.degenerate, 0U);
  EXPECT_EQ(check.orphan_nodes, facts.orphans);
  EXPECT_EQ(check.boundary.open_edges, 0U);
  EXPECT_EQ(check.boundary.non_manifold_edges, 0U);
  EXPECT_EQ(check.boundary.non_manifold_vertices, facts.pinched_vertices);
  if (facts.boundary_triangles != 0)  // the list of facts says nothing more of the others
  {
    EXPECT_EQ(check.slivers, facts.slivers);
    EXPECT_EQ(check.boundary_triangles, facts.boundary_triangles);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, RealVolume, testing::ValuesIn(kVolumes));

struct SurfaceFacts
{
  const char* file;
  std::size_t nodes;
  std::size_t triangles;
  double volume_mm3;
  double volume_digits_mm3;  ///< half of the last digit the volume is given with
  std::size_t parts;
  std::size_t open_edges;
  std::size_t flipped_edges;
  std::size_t non_manifold_edges;
  std::size_t pinched_vertices;
  std::size_t duplicates;
};
void PrintTo(const SurfaceFacts& facts, std::ostream* out)
{
  *out << facts.file;
}

const SurfaceFacts kSurfaces[] = {
    {"organs/Kidney_left.stl", 3287, 6570, 1.92e5, 500.0, 1, 0, 0, 0, 0, 0},
    {"organs/Liver.stl", 15365, 30726, 1.82e6, 5000.0, 1, 0, 0, 0, 0, 0},
    {"organs/Stomach.stl", 4864, 9724, 2.89e5, 500.0, 1, 0, 0, 0, 0, 0},
    {"hard/liver.vtk", 5008, 10000, -1.48e6, 5000.0, 4, 0, 0, 0, 0, 0},
    {"hard/liver_collision.stl", 279, 479, 1.75e6, 5000.0, 16, 31, 28, 2, 13, 3},
};

class RealSurface : public testing::TestWithParam<SurfaceFacts>
{};

TEST_P(RealSurface, loadsWithATrueReportAndIsNoVolume)
{
  if (dataFolder().empty())
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  const SurfaceFacts& facts = GetParam();
  const std::string path = dataFolder() + "/" + facts.file;
  const SurfaceCheck check = checkSurface(loadTriMesh(path, 1e-3).mesh);
  EXPECT_EQ(check.nodes, facts.nodes);
  EXPECT_EQ(check.triangles, facts.triangles);
  EXPECT_NEAR(1e9 * check.volume_m3, facts.volume_mm3, facts.volume_digits_mm3);
  EXPECT_EQ(check.topology.parts, facts.parts);
  EXPECT_EQ(check.topology.open_edges, facts.open_edges);
  EXPECT_EQ(check.topology.flipped_edges, facts.flipped_edges);
  EXPECT_EQ(check.topology.non_manifold_edges, facts.non_manifold_edges);
  EXPECT_EQ(check.topology.non_manifold_vertices, facts.pinched_vertices);
  EXPECT_EQ(check.duplicate_triangles, facts.duplicates);
  EXPECT_EQ(check.watertight(), std::string(facts.file).substr(0, 6) == "organs");
  EXPECT_THROW(loadTetMesh(path, 1e-3), Error);
}

INSTANTIATE_TEST_SUITE_P(Files, RealSurface, testing::ValuesIn(kSurfaces));

struct RefusedFile
{
  const char* file;
  const char* message;  ///< follows the path
};
void PrintTo(const RefusedFile& refused, std::ostream* out)
{
  *out << refused.file;
}

const RefusedFile kRefused[] = {
    {"hard/Armadillo_Tetra_4406_for_test_broken.vtu", ":1451: the array holds more than the 1445"},
    {"hard/WrongDataTetrahedron.ply", ":74: a tet has 3 nodes, must have 4"},
    {"hard/WrongPlyTetrahedron.ply", ":5: the PLY vertices have no property z"},
    {"hard/liver_for_test_broken.vtk", ": byte 87: node 0 has coordinate y = 2.08587e+14 m"},
    {"hard/meshtest_nomesh.stl", ": is an empty mesh"},
};

class RefusedRealFile : public testing::TestWithParam<RefusedFile>
{};

TEST_P(RefusedRealFile, namesPlaceAndReason)
{
  if (dataFolder().empty())
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  const std::string path = dataFolder() + "/" + GetParam().file;
  try
  {
    loadMesh(path, 1e-3);
    FAIL() << "was read";
  }
  catch (const Error& error)
  {
    const std::string start = path + GetParam().message;
    EXPECT_EQ(std::string(error.what()).substr(0, start.size()), start);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, RefusedRealFile, testing::ValuesIn(kRefused));

TEST(RealMeshFiles, allHaveAnExpectedOutcome)
{
  if (dataFolder().empty())
  {
    GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
  }
  std::set<std::string> known;
  for (const VolumeFacts& facts : kVolumes)
  {
    known.insert(facts.file);
  }
  for (const SurfaceFacts& facts : kSurfaces)
  {
    known.insert(facts.file);
  }
  for (const RefusedFile& refused : kRefused)
  {
    known.insert(refused.file);
  }
  for (const std::string folder : {"tissue", "organs", "hard", "beams"})
  {
    for (const auto& entry : fs::directory_iterator(dataFolder() + "/" + folder))
    {
      EXPECT_EQ(known.count(folder + "/" + entry.path().filename().string()), 1U) << entry.path();
    }
  }
}
}  // namespace
}  // namespace soft_tissue
