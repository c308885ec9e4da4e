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

/** What a scene of free tissues without gravity keeps, and the energy it can only lose. */
struct Balance
{
  Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();  ///< the latter about the world's origin
  double energy = 0.0;

  Balance(const Scene& scene, const Snapshot& snapshot)
  {
    for (std::size_t k = 0; k < snapshot.tissues.size(); ++k)
    {
      const TetMesh& rest = scene.tissues()[k].rest;
      const MaterialConfig& material = scene.config().tissues[k].material;
      const TissueState& state = snapshot.tissues[k];
      std::vector<double> masses(rest.nodes.size(), 0.0);
      addLumpedMasses(rest, std::vector<double>(rest.tets.size(), material.density_kg_per_m3), 0,
                      masses);
      TetElasticity elasticity(
          rest, material.model,
          {rest.tets.size(), {material.young_modulus_pa, material.poisson_ratio}}, 0);
      energy += elasticity.value(state.positions);
      for (std::size_t i = 0; i < masses.size(); ++i)
      {
        const Vec3 p = masses[i] * state.velocities[i];
        momentum += p;
        angular += state.positions[i].cross(p);
        energy += 0.5 * p.dot(state.velocities[i]);
      }
    }
    for (const TissuePairState& pair : snapshot.tissue_pairs)
    {
      for (const ContactPoint& point : pair.contacts)
      {
        energy += 0.5 * point.force_W.norm() * point.depth;
      }
    }
  }
};

// Two balls meet off their centres, push each other, spin and part again.
TEST_P(TissueOnTissue, CollidingFreeBodiesKeepTheirMomentumAndGainNoEnergy)
{
  const ScratchFolder folder;
  const std::string ball = saved(folder, "ball.msh", makeBall(0.02, 1000));
  for (const double tolerance : {1e-3, 1e-8})
  {
    SceneConfig config = tissueScene(ball);
    config.solver.tolerance = tolerance;
    config.solver.max_iterations = 60;
    config.tissues[0].pose.position_m = Vec3(-0.025, 0.0, 0.0);
    config.tissues[0].velocity_m_per_s = Vec3(0.5, 0.0, 0.0);
    TissueConfig& other = addTissue(config, "other", ball, {0.025, 0.008, 0.003});
    other.velocity_m_per_s = Vec3(-0.3, 0.05, 0.0);
    addPair(config, "tissue", "other", GetParam()).friction = 0.2;
    Scene scene(config);
    Snapshot snapshot;
    scene.fillSnapshot(snapshot);
    const Balance start(scene, snapshot);
    int most_contacts = 0;
    double momentum = 0.0, angular = 0.0, gained = 0.0, last = start.energy;
    for (int k = 0; k < 30; ++k)
    {
      most_contacts = std::max(most_contacts, scene.step().contacts);
      scene.fillSnapshot(snapshot);
      const Balance now(scene, snapshot);
      momentum = std::max(momentum, (now.momentum - start.momentum).norm());
      angular = std::max(angular, (now.angular - start.angular).norm());
      gained = std::max(gained, now.energy - last);
      last = now.energy;
    }
    momentum /= start.momentum.norm();
    angular /= start.angular.norm();
    gained /= start.energy;
    std::printf(
        "  momentum off by %.1e, angular momentum by %.1e; of the energy %.2f are left, at "
        "most %.1e gained in a step\n",
        momentum, angular, last / start.energy, gained);
    EXPECT_GT(most_contacts, 10);
    EXPECT_EQ(snapshot.report.contacts, 0) << "parted";
    EXPECT_LT(momentum, 1e-12);
    EXPECT_LT(angular, 1e-12);
    EXPECT_LT(gained, 5e-6);
  }
}
}  // namespace
}  // namespace soft_tissue::test
