#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/mass_terms.h"
#include "support/one_tet.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
Snapshot snapshotOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot;
}

class OneTetSwings : public testing::Test
{
 protected:
  /** Largest error of the tip's place within a period of its motion along an axis, in units of its
   * amplitude, taken in so many steps a period. */
  double errorOf(Stepper stepper, int axis, int steps) const
  {
    const double omega = axis == 2 ? OneTet::upAndDown() : OneTet::sidewards();
    const double amplitude = 3e-5 * OneTet::kHeight;  // small, but far above rounding
    SceneConfig config = OneTet::scene(folder_, omega * amplitude * Vec3::Unit(axis));
    config.solver.stepper = stepper;
    config.time_step_s = 2.0 * M_PI / omega / steps;
    Scene scene(config);
    const Vec3 rest = scene.tissues()[0].rest.nodes[OneTet::kTip];
    double most = 0.0;
    for (int n = 1; n <= steps; ++n)
    {
      EXPECT_FALSE(scene.step().held);
      const Vec3 moved = snapshotOf(scene).tissues[0].positions[OneTet::kTip] - rest;
      const Vec3 exact = amplitude * std::sin(omega * scene.time()) * Vec3::Unit(axis);
      most = std::max(most, (moved - exact).norm() / amplitude);
    }
    return most;
  }

  ScratchFolder folder_;
};

TEST_F(OneTetSwings, AsTheSineWithTheOrderOfTheStepper)
{
  for (const int axis : {0, 1, 2})
  {
    for (const Stepper stepper : {Stepper::implicit_euler, Stepper::bdf2})
    {
      const double coarse = errorOf(stepper, axis, 100), fine = errorOf(stepper, axis, 200);
      const double finest = errorOf(stepper, axis, 400);
      const double orders[] = {std::log2(coarse / fine), std::log2(fine / finest)};
      const bool bdf2 = stepper == Stepper::bdf2;
      std::printf("  %s, along %c: errors %.2e %.2e %.2e, orders %.2f %.2f\n",
                  bdf2 ? "bdf2" : "implicit Euler", "xyz"[axis], coarse, fine, finest, orders[0],
                  orders[1]);
      for (const double order : orders)
      {
        EXPECT_NEAR(order, bdf2 ? 2.0 : 1.0, 0.2);
      }
      EXPECT_LT(finest, bdf2 ? 1e-3 : 0.05);
    }
  }
}

// The formula for equal steps as textbooks have it, after a first step of implicit Euler.
TEST_F(OneTetSwings, StepByStepAsTheTwoStepRecurrence)
{
  const double omega = OneTet::upAndDown(), h = 0.3 / omega;
  const double speed = 1e-6 * OneTet::kHeight * omega;
  SceneConfig config = OneTet::scene(folder_, Vec3(0.0, 0.0, speed));
  config.solver.stepper = Stepper::bdf2;
  config.time_step_s = h;
  Scene scene(config);
  const double rest = scene.tissues()[0].rest.nodes[OneTet::kTip].z();
  double x0 = 0.0, v0 = speed;
  double x1 = (x0 + h * v0) / (1.0 + h * h * omega * omega), v1 = (x1 - x0) / h;
  for (int n = 1; n <= 60; ++n)
  {
    ASSERT_FALSE(scene.step().held);
    const TissueState tip = snapshotOf(scene).tissues[0];
    ASSERT_NEAR(tip.positions[OneTet::kTip].z() - rest, x1, 1e-5 * speed / omega) << n;
    ASSERT_NEAR(tip.velocities[OneTet::kTip].z(), v1, 1e-5 * speed) << n;
    // 3 x2 - 4 x1 + x0 = 2 h v2, 3 v2 - 4 v1 + v0 = -2 h omega^2 x2
    const double x2 =
        (3.0 * (4.0 * x1 - x0) + 2.0 * h * (4.0 * v1 - v0)) / (9.0 + 4.0 * h * h * omega * omega);
    const double v2 = (3.0 * x2 - 4.0 * x1 + x0) / (2.0 * h);
    x0 = x1;
    v0 = v1;
    x1 = x2;
    v1 = v2;
  }
}

// The trapezoidal rule would swing to and fro for ever.
TEST_F(OneTetSwings, NoMoreWhereStepsAreFarTooLongForIt)
{
  SceneConfig config = OneTet::scene(folder_, Vec3(1e-3, 2e-3, -1e-3));
  config.solver.stepper = Stepper::bdf2;
  config.time_step_s = 0.5;
  const double swings = config.time_step_s * OneTet::sidewards();
  ASSERT_GT(swings, 199.0);
  Scene scene(config);
  const Vec3 rest = scene.tissues()[0].rest.nodes[OneTet::kTip];
  const double reach = config.tissues[0].velocity_m_per_s.norm() / OneTet::sidewards();
  for (int n = 1; n <= 10; ++n)
  {
    scene.step();
    const Vec3 moved = snapshotOf(scene).tissues[0].positions[OneTet::kTip] - rest;
    EXPECT_LT(moved.norm(), 2.0 / swings * reach) << n;
    if (n > 3)
    {
      EXPECT_LT(moved.norm(), 1e-5 * reach) << n;
    }
  }
}

TEST(SecondOrder, FreeFallIsExact)
{
  const ScratchFolder folder;
  SceneConfig config = blockScene(folder, {3, 3, 2});
  config.solver.stepper = Stepper::bdf2;
  config.solver.tolerance = 1e-10;
  const Vec3 g(1.0, -2.0, -9.81), v(0.3, 0.0, 1.0);
  config.gravity_m_per_s2 = g;
  config.tissues[0].velocity_m_per_s = v;
  Scene scene(config);
  const Points rest = scene.tissues()[0].rest.nodes;
  for (int n = 1; n <= 50; ++n)
  {
    ASSERT_FALSE(scene.step().held);
    const Snapshot now = snapshotOf(scene);
    const double t = scene.time();
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      ASSERT_LT((now.tissues[0].positions[i] - rest[i] - t * v - 0.5 * t * t * g).norm(), 1e-10);
      ASSERT_LT((now.tissues[0].velocities[i] - v - t * g).norm(), 1e-8);
    }
  }
}

/** A lobe that flies at a ball; nothing is fixed. */
SceneConfig thrownLobe(double young_modulus_pa, double time_step_s, Response response)
{
  SceneConfig config = lobeScene();
  config.time_step_s = time_step_s;
  config.solver.stepper = Stepper::bdf2;
  config.tissues[0].velocity_m_per_s = Vec3(0.0, 0.0, -0.5);
  config.tissues[0].material.young_modulus_pa = young_modulus_pa;
  PoseConfig below;
  below.position_m = kLobeSpot - 0.025 * Vec3::UnitZ();
  addTool(config, SphereShape{0.02}, below, response);
  config.contacts[0].stiffness_pa_per_m.reset();
  return config;
}

/** Momentum, angular momentum about the origin, and kinetic energy of all tissues. */
struct Sums
{
  Vec3 momentum = Vec3::Zero(), spin = Vec3::Zero();
  double energy = 0.0;

  explicit Sums(const Scene& scene)
  {
    const Snapshot now = snapshotOf(scene);
    for (std::size_t k = 0; k < now.tissues.size(); ++k)
    {
      const TetMesh& rest = scene.tissues()[k].rest;
      const double density = scene.config().tissues[k].material.density_kg_per_m3;
      std::vector<double> masses(rest.nodes.size(), 0.0);
      addLumpedMasses(rest, std::vector<double>(rest.tets.size(), density), 0, masses);
      for (std::size_t i = 0; i < masses.size(); ++i)
      {
        const Vec3& v = now.tissues[k].velocities[i];
        momentum += masses[i] * v;
        spin += masses[i] * now.tissues[k].positions[i].cross(v);
        energy += 0.5 * masses[i] * v.squaredNorm();
      }
    }
  }
};

// What a wall does to a body in one step must not be carried on: it would come back faster.
TEST(SecondOrder, ABlowNeverThrowsBackFaster)
{
  for (const Response response : {Response::point, Response::segment})
  {
    for (const double young : {5e3, 1e6})
    {
      for (const double h : {0.002, 0.005, 0.01, 0.02, 0.05})
      {
        Scene scene(thrownLobe(young, h, response));
        const double start = Sums(scene).energy;
        double last = 0.0;
        int touching = 0;
        while (scene.time() < 0.2)
        {
          EXPECT_FALSE(scene.step().held) << h << " " << scene.time();
          touching += snapshotOf(scene).report.contacts > 0 ? 1 : 0;
          last = Sums(scene).energy;
          EXPECT_LE(last, 1.0001 * start) << h << " " << scene.time();
        }
        std::printf("  E %g kPa, steps of %g ms: %.0f %% of the energy comes back\n", 1e-3 * young,
                    1e3 * h, 100.0 * last / start);
        EXPECT_GT(touching, 0);
      }
    }
  }
}

// All of a small stiff cube stops at once on a plate: the hardest blow there is.
TEST(SecondOrder, ACubeThatFallsFlatStaysDown)
{
  const ScratchFolder folder;
  SceneConfig config =
      tissueScene(saved(folder, "cube.msh", makeBox({1, 1, 1}, Vec3::Constant(0.01))));
  config.solver.stepper = Stepper::bdf2;
  config.tissues[0].material.young_modulus_pa = 1e6;
  config.tissues[0].velocity_m_per_s = Vec3(0.0, 0.0, -0.5);
  PoseConfig below;
  below.position_m = Vec3(0.005, 0.005, -0.0151);
  addTool(config, BoxShape{Vec3(0.1, 0.1, 0.03)}, below, Response::segment);
  config.contacts[0].stiffness_pa_per_m = 1e9;
  for (const double h : {0.002, 0.005, 0.01})
  {
    config.time_step_s = h;
    Scene scene(config);
    const double start = Sums(scene).energy;
    for (int n = 0; n < 30; ++n)
    {
      EXPECT_FALSE(scene.step().held) << h << " " << n;
    }
    const double back = Sums(scene).energy / start;
    std::printf("  steps of %g ms: %.2f %% of the energy comes back\n", 1e3 * h, 100.0 * back);
    EXPECT_LT(back, 0.01) << h;
  }
}

TEST(SecondOrder, HardStepsAddNoEnergy)
{
  const ScratchFolder folder;
  SceneConfig config = blockScene(folder, {3, 3, 2});
  fixBelow(config, 1e-6);
  config.solver.stepper = Stepper::bdf2;
  config.time_step_s = 0.1;
  config.tissues[0].velocity_m_per_s = Vec3(1.0, 0.0, 0.5);
  for (const double young : {3e3, 3e5, 3e7})
  {
    config.tissues[0].material.young_modulus_pa = young;
    Scene scene(config);
    const double most = Sums(scene).energy;
    for (int n = 0; n < 60; ++n)
    {
      EXPECT_FALSE(scene.step().held) << young << " " << n;
      const double energy = Sums(scene).energy;
      EXPECT_LE(energy, most) << young << " " << n;
    }
    EXPECT_LT(Sums(scene).energy, 1e-3 * most) << young;
  }
}

TEST(SecondOrder, TwoThrownTissuesKeepTheirMomentumAndSpin)
{
  SceneConfig config = lobeScene();
  config.solver.stepper = Stepper::bdf2;
  addTissue(config, "other", SOURCE_DIR "/config/meshes/ball.msh", Vec3(0.01, 0.0, 0.075));
  config.tissues[0].velocity_m_per_s = Vec3(0.0, 0.0, 1.0);
  addPair(config, "tissue", "other", Response::segment);
  Scene scene(config);
  const Sums start(scene);
  int touching = 0;
  for (int n = 0; n < 60; ++n)
  {
    touching += scene.step().contacts > 0 ? 1 : 0;
    const Sums now(scene);
    EXPECT_LT((now.momentum - start.momentum).norm(), 1e-12 * start.momentum.norm()) << n;
    EXPECT_LT((now.spin - start.spin).norm(), 1e-12 * 0.1 * start.momentum.norm()) << n;  // m
  }
  EXPECT_GT(touching, 3);
}

/** Presses a ball into a held lobe and rubs it to and fro. */
class RubbedLobe : public testing::Test
{
 protected:
  static SceneConfig config()
  {
    SceneConfig config = lobeScene();
    fixBelow(config, 0.001);
    config.gravity_m_per_s2.z() = -9.81;
    config.solver.stepper = Stepper::bdf2;
    PoseConfig start;
    start.position_m = kLobeSpot + (kLobeTop + 0.0085) * Vec3::UnitZ();
    addTool(config, SphereShape{0.008}, start, Response::segment);
    config.contacts[0].friction = 0.3;
    return config;
  }

  static void rub(Scene& scene, int step)
  {
    Pose goal =
        raised(scene.config().tools[0].initial_pose.toPose(), -0.0045 * std::min(1.0, step / 40.0));
    goal.translation().x() += 0.002 * std::sin(0.1 * step);
    scene.setToolTarget(0, goal);
    scene.step();
  }
};

TEST_F(RubbedLobe, GoesOnAfterAResetAsFromAFreshStart)
{
  Scene fresh(config()), used(config());
  for (int n = 1; n <= 60; ++n)
  {
    rub(used, n);
  }
  used.resetWorld();
  for (int n = 1; n <= 60; ++n)
  {
    rub(fresh, n);
    rub(used, n);
    ASSERT_EQ(snapshotOf(fresh).tissues[0].positions, snapshotOf(used).tissues[0].positions) << n;
    ASSERT_EQ(snapshotOf(fresh).tissues[0].velocities, snapshotOf(used).tissues[0].velocities) << n;
  }
}

TEST_F(RubbedLobe, HasTheSameBitsForAnyThreads)
{
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2})
  {
    setThreadCount(threads);
    Scene scene(config());
    for (int n = 1; n <= 60; ++n)
    {
      rub(scene, n);
    }
    hashes.push_back(scene.stateHash());
  }
  setThreadCount(1);
  EXPECT_EQ(hashes[0], hashes[1]);
}

// The positions of the last step are part of the state: without them two scenes would look the same
// and go on differently.
TEST_F(RubbedLobe, HashesThePast)
{
  SceneConfig still = config();
  still.solver.stepper = Stepper::bdf2;
  Scene scene(still), euler([&] {
    SceneConfig other = still;
    other.solver.stepper = Stepper::implicit_euler;
    return other;
  }());
  rub(scene, 1);  // a first step carries nothing on: both are the same
  rub(euler, 1);
  ASSERT_EQ(snapshotOf(scene).tissues[0].positions, snapshotOf(euler).tissues[0].positions);
  EXPECT_NE(scene.stateHash(), euler.stateHash());
}

}  // namespace
}  // namespace soft_tissue::test
