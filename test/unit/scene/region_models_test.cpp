#include <gtest/gtest.h>

#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kLength = 0.04;  // m
constexpr double kYoung = 5000.0;
constexpr double kPulled = 1.25;  // mean stretch

/** A bar along x, its half at the end with tag 2, both ends held, that end moved. */
SceneConfig barScene(const ScratchFolder& folder, ElementKind kind)
{
  TetMesh mesh = makeBox({8, 2, 2}, {kLength, 0.01, 0.01});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    double sum = 0.0;
    for (const Index node : mesh.tets[t])
    {
      sum += mesh.nodes[node].x();
    }
    mesh.tags[t] = sum > 2.0 * kLength ? 2 : 1;
  }
  const std::string file = folder.path("bar.msh");
  saveGmsh(file, mesh);
  SceneConfig config = tissueScene(file);
  TissueConfig& tissue = config.tissues[0];
  tissue.element = kind;
  tissue.material = {MaterialModel::linear, kYoung, 0.0, 1000.0, {}};
  tissue.fixed.push_back({Vec3(-1e-9, -1.0, -1.0), Vec3(1e-9, 1.0, 1.0)});
  NodeMotionConfig motion;
  motion.nodes = {Vec3(kLength - 1e-9, -1.0, -1.0), Vec3(kLength + 1e-9, 1.0, 1.0)};
  motion.motion.resize(2);
  motion.motion[1].time_s = config.time_step_s;
  motion.motion[1].pose.position_m.x() = (kPulled - 1.0) * kLength;
  tissue.keyframes.push_back(motion);
  config.solver.stepper = Stepper::quasi_static;
  config.solver.tolerance = 1e-10;
  config.solver.max_iterations = 100;
  config.outputs.stress = true;
  return config;
}

class RegionModels : public ::testing::TestWithParam<ElementKind>
{
 protected:
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Elements, RegionModels,
                         ::testing::Values(ElementKind::tet4, ElementKind::tet4_anp,
                                           ElementKind::tet10));

// Without lateral contraction the bar is two springs in a row, of the same nominal stress.
TEST_P(RegionModels, PullEachOtherWithTheSameStress)
{
  SceneConfig config = barScene(folder_, GetParam());
  RegionConfig region;
  region.tag = 2;
  region.model = MaterialModel::st_venant_kirchhoff;
  config.tissues[0].regions.push_back(region);
  Scene scene(config);
  const StepReport& report = scene.step();
  ASSERT_TRUE(report.converged);
  double low = 1.0, high = 2.0 * kPulled - 1.0;  // stretch of the linear half
  const auto green = [](double s) { return 0.5 * kYoung * s * (s * s - 1.0); };
  for (int k = 0; k < 60; ++k)
  {
    const double s = 0.5 * (low + high);
    (kYoung * (s - 1.0) < green(2.0 * kPulled - s) ? low : high) = s;
  }
  EXPECT_LT(low, kPulled + 0.1);
  EXPECT_GT(low, kPulled + 0.01);
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const Points& rest = scene.tissues()[0].rest.nodes;
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    const double x = rest[i].x(), half = 0.5 * kLength;
    const double expected =
        low * std::min(x, half) + (2.0 * kPulled - low) * std::max(x - half, 0.0);
    EXPECT_NEAR(snapshot.tissues[0].positions[i].x(), expected, 1e-8);
  }
  const std::vector<float>& stress = snapshot.tissues[0].von_mises;
  ASSERT_EQ(stress.size(), scene.tissues()[0].rest.tets.size());
  for (const float s : stress)
  {
    EXPECT_NEAR(s, kYoung * (low - 1.0), 1e-3);  // of both halves: their section stays as it is
  }
  EXPECT_NEAR(report.min_det_f, std::min(low, 2.0 * kPulled - low), 1e-6);
}

TEST_P(RegionModels, OfOneModelAreOneBody)
{
  SceneConfig config = barScene(folder_, GetParam());
  Scene plain(config);
  RegionConfig region;
  region.tag = 2;
  region.model = MaterialModel::linear;
  config.tissues[0].regions.push_back(region);
  Scene named(config);
  for (Scene* scene : {&plain, &named})
  {
    scene->step();
  }
  EXPECT_EQ(plain.stateHash(), named.stateHash());
}

}  // namespace
}  // namespace soft_tissue
