#include <gtest/gtest.h>

#include <algorithm>

#include "soft_tissue_sim/base/parallel.h"
#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr int kElements = 6 * 4 * 4 * 2;
constexpr int kNodes = 9 * 9 * 5;  // a lattice of half the cells' size: all edges have a middle

/** A block of 4 x 4 x 2 cells of quadratic tets. */
class QuadraticTissue : public ::testing::TestWithParam<MaterialModel>
{
 protected:
  SceneConfig config() const
  {
    SceneConfig config = blockScene(folder_, {4, 4, 2});
    config.tissues[0].material.model = GetParam();
    config.tissues[0].element = ElementKind::tet10;
    return config;
  }
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Models, QuadraticTissue,
                         ::testing::Values(MaterialModel::neo_hookean, MaterialModel::corotated));

TEST_P(QuadraticTissue, ShowsItsElementsCutIntoLinearOnes)
{
  SceneConfig config = this->config();
  fixBelow(config, 1e-9);
  config.outputs.stress = true;
  Scene scene(config);
  const TissueInfo& info = scene.tissues()[0];
  EXPECT_EQ(info.rest.nodes.size(), kNodes);
  EXPECT_EQ(info.rest.tets.size(), 8u * kElements);
  EXPECT_EQ(info.rest.tags.size(), 8u * kElements);
  EXPECT_EQ(info.surface.triangles.size(), 4u * 2 * 2 * (4 * 4 + 4 * 2 + 4 * 2));
  EXPECT_EQ(info.fixed_nodes.size(), 9u * 9u);  // middles of edges among them
  scene.step();
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  EXPECT_EQ(snapshot.tissues[0].positions.size(), kNodes);
  EXPECT_EQ(snapshot.tissues[0].von_mises.size(), 8u * kElements);
}

// As linear ones do: gravity must not deform what nothing holds.
TEST_P(QuadraticTissue, FallsWithoutBeingDeformed)
{
  SceneConfig config = this->config();
  config.solver.tolerance = 1e-10;
  const Vec3 g(1.0, -2.0, -9.81);
  config.gravity_m_per_s2 = g;
  Scene scene(config);
  const Points rest = scene.tissues()[0].rest.nodes;
  const double h = config.time_step_s;
  Snapshot snapshot;
  for (int n = 1; n <= 20; ++n)
  {
    ASSERT_TRUE(scene.step().converged);
    scene.fillSnapshot(snapshot);
    const Vec3 fallen = 0.5 * n * (n + 1) * h * h * g;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      ASSERT_LT((snapshot.tissues[0].positions[i] - rest[i] - fallen).norm(), 1e-9 * fallen.norm());
    }
    EXPECT_NEAR(snapshot.report.min_det_f, 1.0, 1e-6);
  }
}

// A column under its weight: u_z = -rho g (H z - z^2 / 2) / M in uniaxial strain, a quadratic
// function, which quadratic tets hold exactly where loads are those of their shape functions.
TEST_P(QuadraticTissue, SinksUnderItsWeightAsAColumnDoes)
{
  SceneConfig config = this->config();
  config.tissues[0].material.poisson_ratio = 0.0;
  fixBelow(config, 1e-9);
  config.solver.stepper = Stepper::quasi_static;
  config.solver.tolerance = 1e-9;
  const double g = 1e-4;  // so little that all is linear
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -g);
  Scene scene(config);
  ASSERT_TRUE(scene.step().converged);
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const MaterialConfig& material = config.tissues[0].material;
  const double unit = material.density_kg_per_m3 * g / material.young_modulus_pa;
  const Points& rest = scene.tissues()[0].rest.nodes;
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    const double z = rest[i].z();
    const double sinks = unit * (kBlockTop * z - 0.5 * z * z);
    EXPECT_NEAR(snapshot.tissues[0].positions[i].z() - z, -sinks,
                1e-5 * unit * kBlockTop * kBlockTop);
  }
}

TEST_P(QuadraticTissue, HasRegionsByElement)
{
  SceneConfig config = this->config();
  fixBelow(config, 1e-9);
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  SceneConfig with_region = config;
  RegionConfig all;
  all.tag = Scene(config).tissues()[0].rest.tags[0];
  all.young_modulus_pa = 9000.0;
  all.density_kg_per_m3 = 1200.0;
  with_region.tissues[0].regions = {all};
  config.tissues[0].material.young_modulus_pa = 9000.0;
  config.tissues[0].material.density_kg_per_m3 = 1200.0;
  Scene expected(config), scene(with_region);
  const std::uint64_t before = scene.stateHash();
  expected.step();
  scene.step();
  EXPECT_EQ(scene.stateHash(), expected.stateHash());
  EXPECT_NE(scene.stateHash(), before);
}

TEST_P(QuadraticTissue, IsPressedToTheSameBitsByAnyNumberOfThreads)
{
  for (const Response response : {Response::segment, Response::point})
  {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2})
    {
      setThreadCount(threads);
      SceneConfig config = this->config();
      fixBelow(config, 1e-9);
      PoseConfig start;
      start.position_m.z() = kBlockTop + 0.0051;
      addTool(config, SphereShape{0.005}, start, response);
      Scene scene(config);
      for (int n = 1; n <= 10; ++n)
      {
        scene.setToolTarget(0, raised(start.toPose(), -0.0005 * n));
        EXPECT_TRUE(scene.step().converged) << n;
      }
      Snapshot snapshot;
      scene.fillSnapshot(snapshot);
      EXPECT_GT(snapshot.report.contacts, 0);
      EXPECT_GT(snapshot.tools[0].wrench_W.force.z(), 0.0);
      hashes.push_back(snapshot.state_hash);
    }
    setThreadCount(1);
    EXPECT_EQ(hashes[0], hashes[1]);
  }
}

}  // namespace
}  // namespace soft_tissue
