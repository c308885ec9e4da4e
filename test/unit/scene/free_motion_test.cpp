#include <gtest/gtest.h>

#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** A tissue that nothing holds and nothing touches. */
class FreeTissue : public ::testing::TestWithParam<std::tuple<MaterialModel, LinearSolverKind>>
{
 protected:
  SceneConfig config(double tolerance) const
  {
    SceneConfig config = blockScene(folder_, {4, 4, 2});
    config.tissues[0].material.model = std::get<0>(GetParam());
    config.solver.linear = std::get<1>(GetParam());
    config.solver.tolerance = tolerance;
    return config;
  }
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(
    All, FreeTissue,
    ::testing::Combine(::testing::Values(MaterialModel::neo_hookean, MaterialModel::corotated),
                       ::testing::Values(LinearSolverKind::pcg, LinearSolverKind::cholesky)));

// Implicit Euler falls n (n + 1) / 2 h^2 g in n steps, h^2 g n / 2 more than g t^2 / 2.
TEST_P(FreeTissue, FallsAsImplicitEulerDoes)
{
  SceneConfig config = this->config(1e-10);
  const Vec3 g(1.0, -2.0, -9.81);
  config.gravity_m_per_s2 = g;
  Scene scene(config);
  const Points rest = scene.tissues()[0].rest.nodes;
  const double h = config.time_step_s;
  Snapshot snapshot;
  for (int n = 1; n <= 50; ++n)
  {
    ASSERT_FALSE(scene.step().held);
    scene.fillSnapshot(snapshot);
    EXPECT_TRUE(snapshot.report.converged);
    const Vec3 fallen = 0.5 * n * (n + 1) * h * h * g;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      ASSERT_LT((snapshot.tissues[0].positions[i] - rest[i] - fallen).norm(), 1e-9 * fallen.norm());
      ASSERT_LT((snapshot.tissues[0].velocities[i] - n * h * g).norm(), 1e-8 * n * h * g.norm());
    }
    EXPECT_NEAR(snapshot.report.min_det_f, 1.0, 1e-6);
  }
}

TEST_P(FreeTissue, WithoutGravityStaysWhereItIs)
{
  Scene scene(config(1e-3));
  const Points rest = scene.tissues()[0].rest.nodes;
  Snapshot snapshot;
  for (int n = 1; n <= 20; ++n)
  {
    scene.step();
    scene.fillSnapshot(snapshot);
    ASSERT_FALSE(snapshot.report.held) << "step " << n << ": " << snapshot.report.residual;
    EXPECT_TRUE(snapshot.report.converged);
    EXPECT_EQ(snapshot.report.halvings, 0);
    EXPECT_LE(snapshot.report.newton_iterations, 1);
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      ASSERT_LT((snapshot.tissues[0].positions[i] - rest[i]).norm(), 1e-14);
    }
  }
}

TEST_P(FreeTissue, WithoutGravityStaysWhereItIsWhenFixedToo)
{
  for (const Stepper stepper : {Stepper::implicit_euler, Stepper::bdf2, Stepper::quasi_static})
  {
    SceneConfig config = this->config(1e-3);
    config.solver.stepper = stepper;
    fixBelow(config, 0.001);
    Scene scene(config);
    const Points rest = scene.tissues()[0].rest.nodes;
    Snapshot snapshot;
    for (int n = 1; n <= 20; ++n)
    {
      const StepReport& report = scene.step();
      ASSERT_FALSE(report.held) << "step " << n << ": " << report.residual;
      EXPECT_TRUE(report.converged);
      EXPECT_LE(report.newton_iterations, 1);
    }
    scene.fillSnapshot(snapshot);
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      ASSERT_LT((snapshot.tissues[0].positions[i] - rest[i]).norm(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace soft_tissue
