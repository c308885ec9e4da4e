#include "soft_tissue_sim/mesh/tetrahedralize.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/check.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "support/mesh_files.h"
#include "support/mesh_samples.h"

namespace soft_tissue
{
namespace
{
namespace fs = std::filesystem;

/** Runs each test with a PATH and a TMPDIR of its own. */
class Tetrahedralize : public testing::Test
{
 protected:
  void SetUp() override
  {
    old_path_ = std::getenv("PATH");
    fs::create_directory(folder_.path("tmp"));
    setenv("TMPDIR", folder_.path("tmp").c_str(), 1);
  }
  void TearDown() override
  {
    EXPECT_TRUE(fs::is_empty(folder_.path("tmp"))) << "temporary files were left";
    setenv("PATH", old_path_.c_str(), 1);
    unsetenv("TMPDIR");
  }

  /** Puts a shell script in place of a mesher. */
  void fake(const std::string& program, const std::string& script)
  {
    const std::string path = folder_.write(program, "#!/bin/sh\n" + script);
    fs::permissions(path, fs::perms::owner_all);
    setenv("PATH", (folder_.path("") + ":/usr/bin:/bin").c_str(), 1);
  }

  std::string failure(const TriMesh& surface, const TetrahedralizeOptions& options)
  {
    try
    {
      tetrahedralize(surface, options);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  }

  bool installed(const std::string& program) { return fs::exists("/usr/bin/" + program); }

  test::ScratchFolder folder_;
  std::string old_path_;
};

TEST_F(Tetrahedralize, fillsTheSurfaceOfABall)
{
  const TetMesh ball = makeBall(0.05, 2000);
  const TriMesh surface = {
      ball.nodes, extractBoundary(static_cast<Index>(ball.nodes.size()), ball.tets).triangles};
  const double volume_m3 = checkMesh(ball).volume_m3;
  for (const std::string program : {"tetgen", "gmsh"})
  {
    if (!installed(program))
    {
      GTEST_SKIP() << program << " is not installed";
    }
    TetrahedralizeOptions options;
    options.program = program;
    const MeshCheck plain = checkMesh(tetrahedralize(surface, options));
    EXPECT_NEAR(plain.volume_m3, volume_m3, 1e-6 * volume_m3) << program;  // STL holds floats
    EXPECT_EQ(plain.parts, 1U);
    EXPECT_EQ(plain.inverted, 0U);
    options.edge_length_m = 0.005;
    const MeshCheck fine = checkMesh(tetrahedralize(surface, options));
    EXPECT_GT(fine.tets, 2 * plain.tets) << program;
    EXPECT_NEAR(fine.volume_m3, volume_m3, 0.03 * volume_m3) << program;
  }
}

TEST_F(Tetrahedralize, surfaceThatBoundsNoVolumeIsRefusedWithItsCheck)
{
  TriMesh open = test::unitTetSurface();
  open.triangles.pop_back();
  const std::string message = failure(open, {});
  EXPECT_NE(message.find("mesh_tool repair"), std::string::npos) << message;
  EXPECT_NE(message.find("! open edges:              3"), std::string::npos) << message;
}

TEST_F(Tetrahedralize, missingProgramIsNamedWithItsPackage)
{
  setenv("PATH", folder_.path("").c_str(), 1);
  for (const std::string program : {"tetgen", "gmsh"})
  {
    TetrahedralizeOptions options;
    options.program = program;
    EXPECT_EQ(failure(test::unitTetSurface(), options),
              program + " is not installed; on Debian and Ubuntu: sudo apt install " + program);
  }
}

TEST_F(Tetrahedralize, programsOwnWordsAreShown)
{
  fake("tetgen", "echo 'two facets intersect' >&2\nexit 3\n");
  const std::string message = failure(test::unitTetSurface(), {});
  EXPECT_NE(message.find("exit code 3"), std::string::npos) << message;
  EXPECT_NE(message.find("two facets intersect"), std::string::npos) << message;
}

TEST_F(Tetrahedralize, programThatWritesNothingHasFailed)
{
  fake("gmsh", "echo done\n");
  TetrahedralizeOptions options;
  options.program = "gmsh";
  EXPECT_NE(failure(test::unitTetSurface(), options).find("could not fill"), std::string::npos);
}

TEST_F(Tetrahedralize, slowProgramIsEnded)
{
  fake("tetgen", "echo thinking\nsleep 100\n");
  TetrahedralizeOptions options;
  options.timeout_s = 0.5;
  const std::string message = failure(test::unitTetSurface(), options);
  EXPECT_NE(message.find("was ended after 0.5 s"), std::string::npos) << message;
  EXPECT_NE(message.find("thinking"), std::string::npos) << message;
}

TEST_F(Tetrahedralize, optionsAreChecked)
{
  TetrahedralizeOptions options;
  options.program = "netgen";
  EXPECT_NE(failure(test::unitTetSurface(), options).find("must be tetgen or gmsh"),
            std::string::npos);
  options = {};
  options.edge_length_m = -1.0;
  EXPECT_NE(failure(test::unitTetSurface(), options).find("edge length = -1 m"), std::string::npos);
}
}  // namespace
}  // namespace soft_tissue
