#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "support/tissue_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

class ViscousTissue : public ::testing::TestWithParam<ElementKind>
{
 protected:
  SceneConfig config(const std::array<int, 3>& cells = {3, 3, 2}) const
  {
    SceneConfig config = blockScene(folder_, cells);
    config.tissues[0].element = GetParam();
    config.solver.tolerance = 1e-9;
    return config;
  }
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Elements, ViscousTissue,
                         ::testing::Values(ElementKind::tet4, ElementKind::tet4_anp,
                                           ElementKind::tet10));

/** A load that comes at once and stays: u = u_end (1 - g / (1 + g) exp(-t / ((1 + g) T))). */
TEST_P(ViscousTissue, CreepsUnderAConstantLoad)
{
  const double g = 1.5, relaxation_s = 0.5;
  SceneConfig config = this->config();
  config.solver.stepper = Stepper::quasi_static;
  config.time_step_s = 0.005;
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -1e-3);  // strains of some 1e-6
  fixBelow(config, 1e-9);
  Scene elastic(config);
  elastic.step();
  config.tissues[0].material.relaxation = {{g, relaxation_s}};
  Scene viscous(config);
  const Points rest = viscous.tissues()[0].rest.nodes;
  Snapshot end, now;
  elastic.fillSnapshot(end);
  for (int k = 0; k < 400; ++k)
  {
    ASSERT_TRUE(viscous.step().converged);
    viscous.fillSnapshot(now);
    const double t = viscous.time() - 0.5 * config.time_step_s;  // the load comes within a step
    const double share = 1.0 - g / (1.0 + g) * std::exp(-t / ((1.0 + g) * relaxation_s));
    for (std::size_t i = 0; i < rest.size(); i += 7)
    {
      const Vec3 expected = share * (end.tissues[0].positions[i] - rest[i]);
      ASSERT_LT((now.tissues[0].positions[i] - rest[i] - expected).norm(),
                1e-3 * expected.norm() + 1e-14)
          << t;
    }
  }
}

TEST_P(ViscousTissue, ResetForgetsAndTheHashRemembers)
{
  SceneConfig config = this->config({2, 2, 1});
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  fixBelow(config, 1e-9);
  config.tissues[0].material.relaxation = {{2.0, 0.1}};
  config.tissues[0].material.stiffness_damping_s = 0.01;
  Scene scene(config), twin(config);
  Snapshot first, again;
  for (int k = 0; k < 5; ++k)
  {
    scene.step();
    twin.step();
    EXPECT_EQ(scene.stateHash(), twin.stateHash());
  }
  scene.fillSnapshot(first);
  scene.resetWorld();
  for (int k = 0; k < 5; ++k)
  {
    scene.step();
  }
  scene.fillSnapshot(again);
  EXPECT_EQ(first.tissues[0].positions, again.tissues[0].positions);
  // At rest again in all but memory: held where it was not, and put back.
  config.gravity_m_per_s2.setZero();
  config.solver.stepper = Stepper::quasi_static;
  NodeMotionConfig motion;
  motion.nodes = {Vec3(-1.0, -1.0, 1e-6), Vec3(1.0, 1.0, 1.0)};
  motion.motion.resize(3);
  motion.motion[1].time_s = config.time_step_s;
  motion.motion[2].time_s = 2.0 * config.time_step_s;
  config.tissues[0].keyframes.push_back(motion);
  config.tissues[0].element = ElementKind::tet4;  // all nodes are held, or moved
  Scene still(config);
  config.tissues[0].keyframes[0].motion[1].pose.position_m.z() = 0.005;
  Scene moved(config);
  for (int k = 0; k < 2; ++k)
  {
    still.step();
    moved.step();
  }
  still.fillSnapshot(first);
  moved.fillSnapshot(again);
  EXPECT_EQ(first.tissues[0].positions, again.tissues[0].positions);
  EXPECT_NE(still.stateHash(), moved.stateHash());
}

TEST_P(ViscousTissue, MassDampingSlowsEverythingAlike)
{
  const double damping = 3.0;
  SceneConfig config = this->config();
  const Vec3 g(0.5, 0.0, -9.81), start(1.0, 2.0, 3.0);
  config.gravity_m_per_s2 = g;
  config.tissues[0].velocity_m_per_s = start;
  config.tissues[0].material.mass_damping_per_s = damping;
  Scene scene(config);
  Vec3 v = start;
  Snapshot snapshot;
  for (int k = 0; k < 50; ++k)
  {
    ASSERT_TRUE(scene.step().converged);
    v = (v + config.time_step_s * g) / (1.0 + damping * config.time_step_s);
    scene.fillSnapshot(snapshot);
    for (const Vec3& node : snapshot.tissues[0].velocities)
    {
      ASSERT_LT((node - v).norm(), 1e-7);
    }
  }
}

/** How the first tissue of a scene turns. */
struct Spin
{
  double energy = 0.0;           ///< twice that of all motion about its centre, J
  Vec3 momentum = Vec3::Zero();  ///< about its centre, kg m^2/s

  explicit Spin(const Scene& scene)
  {
    const TissueInfo& info = scene.tissues()[0];
    std::vector<double> masses(info.rest.nodes.size(), 0.0);
    addLumpedMasses(info.rest, std::vector<double>(info.rest.tets.size(), 1000.0), 0, masses);
    Snapshot snapshot;
    scene.fillSnapshot(snapshot);
    const TissueState& state = snapshot.tissues[0];
    double mass = 0.0;
    Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero();
    for (std::size_t i = 0; i < masses.size(); ++i)
    {
      mass += masses[i];
      centre += masses[i] * state.positions[i];
      velocity += masses[i] * state.velocities[i];
    }
    centre /= mass;
    velocity /= mass;
    for (std::size_t i = 0; i < masses.size(); ++i)
    {
      const Vec3 v = state.velocities[i] - velocity;
      energy += masses[i] * v.squaredNorm();
      momentum += masses[i] * (state.positions[i] - centre).cross(v);
    }
  }
};

constexpr int kSpinSteps = 300;

/** A block that another has hit off its centre, when they have parted, and kSpinSteps later. */
std::vector<Spin> spinsOf(const std::function<void(MaterialConfig&)>& damp)
{
  ScratchFolder folder;
  const std::string block = saved(folder, "block.msh", makeBox({3, 3, 3}, {0.03, 0.03, 0.03}));
  SceneConfig config = tissueScene(block);
  config.solver.tolerance = 1e-9;
  config.time_step_s = 0.005;
  damp(config.tissues[0].material);
  addTissue(config, "other", block, {0.02, 0.0, 0.0305}).velocity_m_per_s = {0.0, 0.0, -0.5};
  addPair(config, "tissue", "other", Response::segment);
  Scene scene(config);
  std::vector<Spin> spins;
  for (int k = 0; k <= 80 + kSpinSteps; ++k)
  {
    scene.step();
    if (k == 80 || k == 80 + kSpinSteps)
    {
      Snapshot snapshot;
      scene.fillSnapshot(snapshot);
      EXPECT_EQ(snapshot.report.contacts, 0);
      spins.push_back(Spin(scene));
    }
  }
  EXPECT_GT(spins[0].momentum.norm(), 1e-6);
  return spins;
}

TEST(ViscousSpin, GoesOnUnderStiffnessDamping)
{
  const std::vector<Spin> spins =
      spinsOf([](MaterialConfig& material) { material.stiffness_damping_s = 0.02; });
  const double energy = spins[1].energy / spins[0].energy;
  std::printf("  energy left %.5f\n", energy);
  EXPECT_LT((spins[1].momentum - spins[0].momentum).norm(), 1e-9 * spins[0].momentum.norm());
  EXPECT_GT(energy, 0.999);
  EXPECT_LT(energy, 1.001);
}

TEST(ViscousSpin, FadesUnderMassDamping)
{
  const double damping = 2.0, h = 0.005;
  const std::vector<Spin> spins =
      spinsOf([&](MaterialConfig& material) { material.mass_damping_per_s = damping; });
  const Vec3 expected = spins[0].momentum * std::pow(1.0 + damping * h, -kSpinSteps);
  std::printf("  spin %.5f of what it should be\n", spins[1].momentum.norm() / expected.norm());
  EXPECT_LT((spins[1].momentum - expected).norm(), 0.01 * expected.norm());
}

}  // namespace
}  // namespace soft_tissue
