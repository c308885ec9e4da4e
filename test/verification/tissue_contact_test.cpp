#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/geometry/box3.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kGravity = 9.81;

class TissueOnTissue : public testing::TestWithParam<Response>
{};

INSTANTIATE_TEST_SUITE_P(Responses, TissueOnTissue,
                         testing::Values(Response::point, Response::segment));

/** A scene of blocks in which a step is solved well. */
SceneConfig carefulScene(const std::string& mesh_file)
{
  SceneConfig config = tissueScene(mesh_file);
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -kGravity);
  config.solver.tolerance = 1e-5;
  config.solver.max_iterations = 60;
  return config;
}

/** What presses on each node of a face that lies at this height at rest, over its area, Pa: the
 * contact force that balances elasticity and weight. Nodes nearer to the face's rim than 8 mm,
 * about an edge, are left out: at the rim nearest is the side of a body, not its face. */
std::vector<double> pressuresAt(const TissueInfo& info, const Points& x, const SceneConfig& config,
                                double height)
{
  const MaterialConfig& material = config.tissues[0].material;
  TetElasticity elasticity(
      info.rest, material.model,
      {info.rest.tets.size(), {material.young_modulus_pa, material.poisson_ratio}}, 0);
  std::vector<double> masses(x.size(), 0.0);
  addLumpedMasses(info.rest, std::vector<double>(info.rest.tets.size(), 1000.0), 0, masses);
  Points force(x.size(), Vec3::Zero());
  elasticity.addGradient(x, force);
  std::vector<double> areas(x.size(), 0.0);
  const Box3 box = boundsOf(info.rest.nodes);
  for (const Triangle& t : info.surface.triangles)
  {
    const bool on = std::all_of(t.begin(), t.end(), [&](Index node) {
      return std::abs(info.rest.nodes[node].z() - height) < 1e-9;
    });
    const double area = 0.5 * (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm();
    for (const Index node : t)
    {
      areas[node] += on ? area / 3.0 : 0.0;
    }
  }
  std::vector<double> pressures;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const Vec3 inwards = (info.rest.nodes[i] - box.min).cwiseMin(box.max - info.rest.nodes[i]);
    if (areas[i] > 0.0 && std::min(inwards.x(), inwards.y()) > 0.008)
    {
      pressures.push_back(std::abs(force[i].z() + masses[i] * kGravity) / areas[i]);
    }
  }
  return pressures;
}

// One block stands on another whose nodes are elsewhere. Without lateral contraction its weight is
// a pressure that is the same everywhere between them.
TEST_P(TissueOnTissue, PressureBetweenMeshesThatDoNotMatchIsUniform)
{
  const ScratchFolder folder;
  const Vec3 size(0.06, 0.06, 0.03);
  SceneConfig config = carefulScene(saved(folder, "below.msh", makeBox({8, 8, 4}, size)));
  config.tissues[0].material.poisson_ratio = 0.0;
  fixBelow(config, 1e-6);
  const double slimmer = 1e-5;
  addTissue(
      config, "above",
      saved(folder, "above.msh", makeBox({11, 7, 5}, size - Vec3(2 * slimmer, 2 * slimmer, 0))),
      {slimmer, slimmer, 0.03});
  addPair(config, "tissue", "above", GetParam());
  Scene scene(config);
  for (int k = 0; k < 300; ++k)
  {
    ASSERT_EQ(scene.step().halvings, 0) << "step " << k;
  }
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const double width = 0.06 - 2.0 * slimmer;
  const double weight = 1000.0 * kGravity * width * width * 0.03;
  const double expected = weight / (width * width);
  for (std::size_t body = 0; body < 2; ++body)
  {
    double worst = 0.0;
    for (const double p :
         pressuresAt(scene.tissues()[body], snapshot.tissues[body].positions, config, 0.03))
    {
      worst = std::max(worst, std::abs(p / expected - 1.0));
    }
    std::printf("  on %s: at most %.2f %% off\n", scene.tissues()[body].name.c_str(), 100 * worst);
    // Nodes of one mesh are no measure of the area of the other's.
    EXPECT_LT(worst, GetParam() == Response::segment ? 0.05 : 0.6);
  }
  EXPECT_NEAR(forceOnFirst(snapshot.tissue_pairs[0]).z(), -weight, 1e-4 * weight);
}

TEST_P(TissueOnTissue, ACubeRestingOnTissueIsCarriedByIt)
{
  const ScratchFolder folder;
  SceneConfig config =
      carefulScene(saved(folder, "bed.msh", makeBox({8, 8, 3}, {0.08, 0.08, 0.03})));
  fixBelow(config, 1e-6);
  addTissue(config, "cube", saved(folder, "cube.msh", makeBox({4, 4, 4}, Vec3::Constant(0.03))),
            {0.024, 0.026, 0.0301});
  addPair(config, "cube", "tissue", GetParam()).friction = 0.3;
  Scene scene(config);
  Snapshot snapshot;
  for (int k = 0; k < 400; ++k)
  {
    ASSERT_EQ(scene.step().halvings, 0) << "step " << k;
  }
  scene.fillSnapshot(snapshot);
  const double weight = 1000.0 * kGravity * 0.03 * 0.03 * 0.03;
  const Vec3 force = forceOnFirst(snapshot.tissue_pairs[0]);
  std::printf("  carried %.6f N of %.6f, off by %.1e; speed %.1e m/s\n", force.z(), weight,
              force.z() / weight - 1.0, rmsSpeed(snapshot));
  EXPECT_NEAR(force.z(), weight, 1e-4 * weight);
}

/** Mass, momentum, energy of motion and angular momentum about the world's origin of all nodes. */
struct Motion
{
  double mass = 0.0, energy = 0.0;
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();

  Motion(const Scene& scene, const Snapshot& snapshot)
  {
    for (std::size_t k = 0; k < snapshot.tissues.size(); ++k)
    {
      const TetMesh& rest = scene.tissues()[k].rest;
      std::vector<double> masses(rest.nodes.size(), 0.0);
      const double density = scene.config().tissues[k].material.density_kg_per_m3;
      addLumpedMasses(rest, std::vector<double>(rest.tets.size(), density), 0, masses);
      for (std::size_t i = 0; i < masses.size(); ++i)
      {
        const Vec3 p = masses[i] * snapshot.tissues[k].velocities[i];
        mass += masses[i];
        momentum += p;
        angular += snapshot.tissues[k].positions[i].cross(p);
        energy += 0.5 * p.dot(snapshot.tissues[k].velocities[i]);
      }
    }
  }
};

// Two balls meet off their centres, push each other and part again.
TEST_P(TissueOnTissue, CollidingFreeBodiesKeepTheirMomentum)
{
  const ScratchFolder folder;
  const std::string ball = saved(folder, "ball.msh", makeBall(0.02, 1000));
  SceneConfig config = carefulScene(ball);
  config.gravity_m_per_s2.setZero();
  config.solver.tolerance = 1e-12;
  if (getenv("NIT")) config.solver.max_iterations = atoi(getenv("NIT"));
  config.tissues[0].pose.position_m = Vec3(-0.025, 0.0, 0.0);
  config.tissues[0].velocity_m_per_s = Vec3(0.5, 0.0, 0.0);
  addTissue(config, "other", ball, {0.025, 0.008, 0.003}).velocity_m_per_s = Vec3(-0.3, 0.05, 0.0);
  addPair(config, "tissue", "other", GetParam()).friction = 0.2;
  Scene scene(config);
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const Motion before(scene, snapshot);
  double most_contacts = 0.0, worst = 0.0, worst_angular = 0.0, last_energy = before.energy;
  for (int k = 0; k < 20; ++k)
  {
    const StepReport& report = scene.step();
    scene.fillSnapshot(snapshot);
    const Motion now(scene, snapshot);
    worst = std::max(worst, (now.momentum - before.momentum).norm() / before.momentum.norm());
    worst_angular =
        std::max(worst_angular, (now.angular - before.angular).norm() / before.angular.norm());
    most_contacts = std::max(most_contacts, double(report.contacts));
    std::printf("  %d: contacts %d, energy %.3e, converged %d newton %d\n", k, report.contacts,
                now.energy, report.converged, report.newton_iterations);
    last_energy = now.energy;
  }
  std::printf("  momentum off by at most %.1e, angular momentum %.1e, energy %.3e of %.3e\n", worst,
              worst_angular, last_energy, before.energy);
  EXPECT_GT(most_contacts, 10);
  EXPECT_LT(worst, 1e-9);
}

TEST_P(TissueOnTissue, AStackOfFiveBlocksComesToRest)
{
  const ScratchFolder folder;
  const std::string block = saved(folder, "block.msh", makeBox({4, 4, 3}, {0.04, 0.04, 0.02}));
  SceneConfig config = tissueScene(block);
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -kGravity);
  config.tissues[0].material.young_modulus_pa = 2e4;
  if (getenv("TOL")) config.solver.tolerance = atof(getenv("TOL"));
  if (getenv("NIT")) config.solver.max_iterations = atoi(getenv("NIT"));
  fixBelow(config, 1e-6);
  const char* names[] = {"tissue", "b1", "b2", "b3", "b4"};
  for (int k = 1; k < 5; ++k)
  {
    addTissue(config, names[k], block, {0.001 * k, -0.0015 * (k % 2), 0.0205 * k});
    addPair(config, names[k - 1], names[k], GetParam()).friction = getenv("MU") ? atof(getenv("MU")) : 0.4;
  }
  Scene scene(config);
  Snapshot snapshot;
  int newton = 0;
  for (int k = 0; k < 1000; ++k)
  {
    const StepReport& r = scene.step();
    newton += r.newton_iterations;
    if (k % 100 == 99)
    {
      scene.fillSnapshot(snapshot);
      std::printf("  %4d: speed %.2e, newton %d, residual %.1e deepest %.2e\n", k,
                  rmsSpeed(snapshot), newton, r.residual, r.max_penetration_m);
    }
  }
}
}  // namespace
}  // namespace soft_tissue::test
