#include "soft_tissue_sim/mesh/mesh_io.h"

#include <gtest/gtest.h>

#include <random>

#include "soft_tissue_sim/base/error.h"
#include "support/mesh_files.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
constexpr double kMm = 1e-3;

class MeshFiles : public testing::Test
{
 protected:
  std::string write(const test::SampleFile& file) const
  {
    if (!file.partner_name.empty())
    {
      folder_.write(file.partner_name, file.partner);
    }
    return folder_.write(file.name, file.content);
  }

  test::ScratchFolder folder_;
};

TEST_F(MeshFiles, everyVolumeFormatGivesTheSameMesh)
{
  const TetMesh mesh = test::twoTets();
  for (const test::SampleFile& file : test::volumeFiles(mesh))
  {
    SCOPED_TRACE(file.format);
    const LoadedTetMesh loaded = loadTetMesh(write(file), kMm);
    EXPECT_EQ(loaded.report.format, file.format);
    ASSERT_EQ(loaded.mesh.nodes.size(), mesh.nodes.size());
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    {
      EXPECT_EQ(loaded.mesh.nodes[i], kMm * mesh.nodes[i]);
    }
    EXPECT_EQ(loaded.mesh.tets, mesh.tets);
    const bool has_tags = file.format.find("vt") != 0 && file.format != "ply ascii";
    EXPECT_EQ(loaded.mesh.tags, has_tags ? mesh.tags : (std::vector<int>{0, 0}));
    EXPECT_EQ(loaded.report.reoriented_tets, 0U);
  }
}

TEST_F(MeshFiles, everySurfaceFormatGivesTheSameTriangles)
{
  const TriMesh mesh = test::unitTetSurface();
  for (const test::SampleFile& file : test::surfaceFiles(mesh))
  {
    SCOPED_TRACE(file.format);
    const LoadedTriMesh loaded = loadTriMesh(write(file), kMm);
    EXPECT_EQ(loaded.report.format, file.format);
    ASSERT_EQ(loaded.mesh.nodes.size(), 4U);
    ASSERT_EQ(loaded.mesh.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        EXPECT_EQ(loaded.mesh.nodes[loaded.mesh.triangles[t][k]],
                  kMm * mesh.nodes[mesh.triangles[t][k]]);
      }
    }
  }
}

TEST_F(MeshFiles, leftHandedTetsAreTurnedAndCounted)
{
  TetMesh mesh = test::twoTets();
  std::swap(mesh.tets[1][0], mesh.tets[1][1]);
  const std::string path = folder_.write("a.msh", test::gmsh2Content(mesh, false));
  const LoadedTetMesh loaded = loadTetMesh(path, 1.0);
  EXPECT_EQ(loaded.report.reoriented_tets, 1U);
  for (const Tet& tet : loaded.mesh.tets)
  {
    const Points& x = loaded.mesh.nodes;
    EXPECT_GT(signedVolume6(x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]), 0.0);
  }
}

TEST_F(MeshFiles, gmshTagFallsBackToTheElementaryOne)
{
  TetMesh mesh = test::unitTet();
  for (const std::string& content :
       {test::gmsh1Text(mesh), test::gmsh2Content(mesh, false), test::gmsh2Content(mesh, true)})
  {
    EXPECT_EQ(loadTetMesh(folder_.write("a.msh", content), 1.0).mesh.tags, std::vector<int>{9});
  }
  const std::string entity = test::gmsh4Content(mesh, false);  // physical 0 of entity 10
  EXPECT_EQ(loadTetMesh(folder_.write("a.msh", entity), 1.0).mesh.tags, std::vector<int>{10});
}

TEST_F(MeshFiles, polygonsBecomeFansAndUnusedNodesAreTold)
{
  const std::string path =
      folder_.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\nf 1 2 3 4\n");
  const LoadedTriMesh loaded = loadTriMesh(path, 1.0);
  EXPECT_EQ(loaded.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  ASSERT_EQ(loaded.report.warnings.size(), 1U);
  EXPECT_EQ(loaded.report.warnings[0], "1 node belongs to no triangle");
}

TEST_F(MeshFiles, savedVolumeIsReadBackBitByBit)
{
  TetMesh mesh = test::twoTets();
  mesh.nodes[4] = Vec3(1.0 / 3.0, 0.7, 1e-17 + 1.1);
  const std::string path = folder_.path("a.msh");
  saveGmsh(path, mesh);
  const LoadedTetMesh loaded = loadTetMesh(path, 1.0);
  EXPECT_EQ(loaded.mesh.nodes, mesh.nodes);
  EXPECT_EQ(loaded.mesh.tets, mesh.tets);
  EXPECT_EQ(loaded.mesh.tags, mesh.tags);
}

TEST_F(MeshFiles, savedSurfaceIsReadBack)
{
  const TriMesh mesh = test::unitTetSurface();
  saveStl(folder_.path("a.stl"), mesh);
  const LoadedTriMesh loaded = loadTriMesh(folder_.path("a.stl"), 1.0);
  EXPECT_EQ(loaded.report.format, "stl binary");
  EXPECT_EQ(loaded.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(loaded.mesh.nodes.size(), mesh.nodes.size());
}

TEST_F(MeshFiles, writingWhereNothingCanBeWrittenIsAnError)
{
  EXPECT_THROW(saveGmsh(folder_.path("no/such/folder.msh"), test::unitTet()), Error);
  EXPECT_THROW(saveStl(folder_.path("no/such/folder.stl"), test::unitTetSurface()), Error);
}

TEST(MetresPerUnit, knowsFourUnitsAndNoOther)
{
  EXPECT_EQ(metresPerUnit("m"), 1.0);
  EXPECT_EQ(metresPerUnit("cm"), 1e-2);
  EXPECT_EQ(metresPerUnit("mm"), 1e-3);
  EXPECT_EQ(metresPerUnit("um"), 1e-6);
  for (const char* unit : {"", "inch", "M", "nm"})
  {
    EXPECT_THROW(metresPerUnit(unit), Error);
  }
}

/** Reads a damaged file: any mesh or an Error naming the file will do, nothing else. */
void expectMeshOrError(const std::string& path)
{
  try
  {
    const LoadedMesh loaded = loadMesh(path, 1.0);
    const auto nodes = static_cast<Index>(loaded.volume.nodes.size() + loaded.surface.nodes.size());
    for (const Tet& tet : loaded.volume.tets)
    {
      for (const Index node : tet)
      {
        ASSERT_TRUE(node >= 0 && node < nodes);
      }
    }
    for (const Triangle& triangle : loaded.surface.triangles)
    {
      for (const Index node : triangle)
      {
        ASSERT_TRUE(node >= 0 && node < nodes);
      }
    }
  }
  catch (const Error& error)
  {
    const std::string stem = path.substr(0, path.rfind('.'));
    EXPECT_EQ(std::string(error.what()).substr(0, stem.size()), stem) << error.what();
  }
}

TEST_F(MeshFiles, truncatedFilesGiveAMeshOrAnError)
{
  std::vector<test::SampleFile> files = test::volumeFiles(test::twoTets());
  const std::vector<test::SampleFile> surfaces = test::surfaceFiles(test::unitTetSurface());
  files.insert(files.end(), surfaces.begin(), surfaces.end());
  for (const test::SampleFile& file : files)
  {
    SCOPED_TRACE(file.format);
    test::SampleFile damaged = file;
    for (std::size_t size = 0; size < file.content.size(); size += 1 + file.content.size() / 60)
    {
      damaged.content = file.content.substr(0, size);
      expectMeshOrError(write(damaged));
    }
  }
}

TEST_F(MeshFiles, flippedBytesGiveAMeshOrAnError)
{
  std::mt19937 random(7);
  std::vector<test::SampleFile> files = test::volumeFiles(test::twoTets());
  const std::vector<test::SampleFile> surfaces = test::surfaceFiles(test::unitTetSurface());
  files.insert(files.end(), surfaces.begin(), surfaces.end());
  for (const test::SampleFile& file : files)
  {
    SCOPED_TRACE(file.format);
    for (int round = 0; round < 100; ++round)
    {
      test::SampleFile damaged = file;
      for (unsigned flips = 1 + random() % 4; flips > 0; --flips)
      {
        const bool digit = random() % 2 == 0;  // digits get further into the readers than noise
        damaged.content[random() % damaged.content.size()] =
            static_cast<char>(digit ? '0' + random() % 10 : random() % 256);
      }
      expectMeshOrError(write(damaged));
    }
  }
}
}  // namespace
}  // namespace soft_tissue
