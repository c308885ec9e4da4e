#include <gtest/gtest.h>

#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** A bar along x that hangs out from a soft foot, its other half much stiffer. */
SceneConfig barOnAFoot(const ScratchFolder& folder, double stiffer, LinearSolverKind linear)
{
  TetMesh mesh = makeBox({6, 2, 2}, {0.06, 0.02, 0.02});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    double sum = 0.0;
    for (const Index node : mesh.tets[t])
    {
      sum += mesh.nodes[node].x();
    }
    mesh.tags[t] = sum > 4.0 * 0.03 ? 2 : 1;
  }
  const std::string file = folder.path("bar.msh");
  saveGmsh(file, mesh);
  SceneConfig config = tissueScene(file);
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  config.tissues[0].material.young_modulus_pa = 2e4;
  config.tissues[0].fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)});
  RegionConfig stiff;
  stiff.tag = 2;
  stiff.young_modulus_pa = stiffer * 2e4;
  config.tissues[0].regions.push_back(stiff);
  config.solver.linear = linear;
  config.solver.max_iterations = 200;  // halved steps would swing otherwise
  return config;
}

// Its forces hide those of the foot, but not from the solver: it swings as with exact linear
// solves.
TEST(StiffPart, SwingsOnItsSoftFootAsExactSolvesSay)
{
  const ScratchFolder folder;
  for (const double stiffer : {1e2, 1e4, 1e6})
  {
    Scene pcg(barOnAFoot(folder, stiffer, LinearSolverKind::automatic));
    Scene exact(barOnAFoot(folder, stiffer, LinearSolverKind::cholesky));
    Snapshot found, expected;
    double most = 0.0, newton = 0.0;
    for (int step = 0; step < 60; ++step)
    {
      const StepReport& report = pcg.step();
      exact.step();
      EXPECT_FALSE(report.held) << stiffer << " " << step;
      EXPECT_GT(report.min_det_f, 0.1) << stiffer << " " << step;
      newton += report.newton_iterations / 60.0;
      pcg.fillSnapshot(found);
      exact.fillSnapshot(expected);
      const Vec3 off = found.tissues[0].positions.back() - expected.tissues[0].positions.back();
      most = std::max(most, off.norm());
    }
    std::printf("  %g times stiffer: %.2g mm off, %.1f iterations a step\n", stiffer, 1e3 * most,
                newton);
    EXPECT_LT(most, 1e-4) << stiffer;
  }
}

}  // namespace
}  // namespace soft_tissue
