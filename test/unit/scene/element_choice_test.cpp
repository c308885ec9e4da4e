#include <gtest/gtest.h>

#include "soft_tissue_sim/base/parallel.h"
#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** What of its rest state tells which element a tissue is computed with. */
std::size_t nodesOf(const SceneConfig& config)
{
  return Scene(config).tissues()[0].rest.nodes.size();
}

SceneConfig with(SceneConfig config, ElementKind element)
{
  config.tissues[0].element = element;
  return config;
}

TEST(ElementChoice, IsQuadraticForCoarseMeshes)
{
  const ScratchFolder folder;
  const SceneConfig coarse = blockScene(folder, {7, 7, 6});  // 1764 tets
  EXPECT_EQ(nodesOf(with(coarse, ElementKind::automatic)),
            nodesOf(with(coarse, ElementKind::tet10)));
  const SceneConfig fine = blockScene(folder, {7, 7, 7});  // 2058
  EXPECT_EQ(nodesOf(with(fine, ElementKind::automatic)), nodesOf(with(fine, ElementKind::tet4)));
}

TEST(ElementChoice, HasNodalPressuresWhereFineMeshesLock)
{
  const ScratchFolder folder;
  SceneConfig config = blockScene(folder, {8, 8, 6});
  fixBelow(config, 1e-9);
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  const auto hashAfterStep = [&](ElementKind element) {
    Scene scene(with(config, element));
    scene.step();
    return scene.stateHash();
  };
  for (const double poisson_ratio : {0.3, 0.4, 0.49})
  {
    config.tissues[0].material.poisson_ratio = poisson_ratio;
    const ElementKind expected = poisson_ratio < 0.4 ? ElementKind::tet4 : ElementKind::tet4_anp;
    EXPECT_EQ(hashAfterStep(ElementKind::automatic), hashAfterStep(expected)) << poisson_ratio;
    EXPECT_NE(hashAfterStep(ElementKind::tet4), hashAfterStep(ElementKind::tet4_anp));
  }
  // A region counts as the rest does.
  config.tissues[0].material.poisson_ratio = 0.3;
  RegionConfig region;
  region.tag = 1;
  region.poisson_ratio = 0.45;
  config.tissues[0].regions = {region};
  EXPECT_EQ(hashAfterStep(ElementKind::automatic), hashAfterStep(ElementKind::tet4_anp));
}

/** A block nearly incompressible. */
class NodalPressureTissue : public ::testing::TestWithParam<MaterialModel>
{
 protected:
  SceneConfig config() const
  {
    SceneConfig config = blockScene(folder_, {5, 5, 3});
    config.tissues[0].element = ElementKind::tet4_anp;
    config.tissues[0].material.model = GetParam();
    config.tissues[0].material.poisson_ratio = 0.499;
    return config;
  }
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Models, NodalPressureTissue,
                         ::testing::Values(MaterialModel::neo_hookean, MaterialModel::corotated));

TEST_P(NodalPressureTissue, FallsWithoutBeingDeformed)
{
  SceneConfig config = this->config();
  config.solver.tolerance = 1e-10;
  const Vec3 g(1.0, -2.0, -9.81);
  config.gravity_m_per_s2 = g;
  Scene scene(config);
  const Points rest = scene.tissues()[0].rest.nodes;
  const double h = config.time_step_s;
  Snapshot snapshot;
  for (int n = 1; n <= 10; ++n)
  {
    ASSERT_TRUE(scene.step().converged);
    scene.fillSnapshot(snapshot);
    const Vec3 fallen = 0.5 * n * (n + 1) * h * h * g;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      ASSERT_LT((snapshot.tissues[0].positions[i] - rest[i] - fallen).norm(), 1e-9 * fallen.norm());
    }
  }
}

// Sidewards it is held by nothing, so a squeezed block keeps the volume that plain tets would lose
// their give to.
TEST_P(NodalPressureTissue, GivesWayMoreThanTetsThatLock)
{
  std::vector<double> sunk;
  for (const ElementKind element : {ElementKind::tet4, ElementKind::tet4_anp})
  {
    SceneConfig config = with(this->config(), element);
    fixBelow(config, 1e-9);
    config.solver.stepper = Stepper::quasi_static;
    config.gravity_m_per_s2 = Vec3(0.0, 0.0, -1.0);
    Scene scene(config);
    ASSERT_TRUE(scene.step().converged);
    Snapshot snapshot;
    scene.fillSnapshot(snapshot);
    double sum = 0.0;
    for (std::size_t i = 0; i < snapshot.tissues[0].positions.size(); ++i)
    {
      sum += (scene.tissues()[0].rest.nodes[i] - snapshot.tissues[0].positions[i]).z();
    }
    sunk.push_back(sum);
  }
  EXPECT_GT(sunk[1], 1.3 * sunk[0]);
}

TEST_P(NodalPressureTissue, IsPressedToTheSameBitsByAnyNumberOfThreadsAndAfterAReset)
{
  for (const LinearSolverKind linear :
       {LinearSolverKind::automatic, LinearSolverKind::pcg, LinearSolverKind::cholesky})
  {
    std::vector<Points> ends;
    const auto press = [&](Scene& scene, const Pose& start) {
      for (int n = 1; n <= 6; ++n)
      {
        scene.setToolTarget(0, raised(start, -0.0005 * n));
        EXPECT_TRUE(scene.step().converged) << n;
      }
      Snapshot snapshot;
      scene.fillSnapshot(snapshot);
      EXPECT_GT(snapshot.tools[0].wrench_W.force.z(), 0.0);
      ends.push_back(snapshot.tissues[0].positions);
    };
    for (const int threads : {1, 2})
    {
      setThreadCount(threads);
      SceneConfig config = this->config();
      config.solver.linear = linear;
      fixBelow(config, 1e-9);
      PoseConfig start;
      start.position_m.z() = kBlockTop + 0.0051;
      addTool(config, SphereShape{0.005}, start, Response::segment);
      Scene scene(config);
      press(scene, start.toPose());
      scene.resetWorld();
      press(scene, start.toPose());
    }
    setThreadCount(1);
    for (const Points& end : ends)
    {
      EXPECT_EQ(end, ends[0]);
    }
  }
}

}  // namespace
}  // namespace soft_tissue
