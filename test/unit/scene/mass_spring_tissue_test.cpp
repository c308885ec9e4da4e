#include <gtest/gtest.h>

#include "bad_scene.h"
#include "soft_tissue_sim/energy/mass_spring.h"
#include "support/small_scenes.h"
#include "support/tissue_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kSide = 0.03;  // m

/** A block whose bottom is held and whose top key frames move. */
SceneConfig heldBlock(const ScratchFolder& folder, double poisson_ratio, const PoseConfig& goal)
{
  const std::string file = saved(folder, "block.msh", makeBox({4, 4, 4}, {kSide, kSide, kSide}));
  SceneConfig config = tissueScene(file);
  config.tissues[0].material = {MaterialModel::mass_spring, 5000.0, poisson_ratio, 1000.0};
  config.solver.stepper = Stepper::quasi_static;
  config.solver.tolerance = 1e-8;
  config.solver.max_iterations = 100;
  fixBelow(config, 1e-9);
  NodeMotionConfig top;
  top.nodes = {Vec3(-1.0, -1.0, kSide - 1e-9), Vec3(1.0, 1.0, 1.0)};
  top.motion.resize(2);
  top.motion[1].time_s = 10.0 * config.time_step_s;
  top.motion[1].pose = goal;
  config.tissues[0].keyframes.push_back(top);
  return config;
}

Points positionsOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot.tissues[0].positions;
}

class MassSpringTissue : public ::testing::TestWithParam<double>
{
 protected:
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(PoissonRatios, MassSpringTissue, ::testing::Values(0.25, 0.45));

TEST_P(MassSpringTissue, IsInBalanceBetweenKeyFrames)
{
  PoseConfig goal;
  goal.position_m = Vec3(0.004, 0.0, 0.009);
  goal.rotation_rpy_rad = Vec3(0.0, 0.2, 0.0);
  Scene scene(heldBlock(folder_, GetParam(), goal));
  for (int step = 0; step < 10; ++step)
  {
    const StepReport& report = scene.step();
    ASSERT_TRUE(report.converged) << step;
    ASSERT_GT(report.min_det_f, 0.1) << step;
  }
  const TetMesh& rest = scene.tissues()[0].rest;
  MassSpring springs(rest, {rest.tets.size(), {5000.0, GetParam()}}, 0);
  const Points x = positionsOf(scene);
  Points forces(x.size(), Vec3::Zero());
  springs.addGradient(x, forces);
  double inside = 0.0, held = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const bool is_held = rest.nodes[i].z() < 1e-9 || rest.nodes[i].z() > kSide - 1e-9;
    double& most = is_held ? held : inside;
    most = std::max(most, forces[i].norm());
  }
  EXPECT_GT(held, 0.01);
  EXPECT_LT(inside, 1e-6 * held);
}

// Springs know nothing of where they point.
TEST_P(MassSpringTissue, FollowsKeyFramesThatTurnItWithoutStrain)
{
  SceneConfig config = heldBlock(folder_, GetParam(), {});
  config.tissues[0].fixed.clear();
  config.solver.tolerance = 1e-10;
  NodeMotionConfig& motion = config.tissues[0].keyframes[0];
  motion.motion[1].pose.rotation_rpy_rad = Vec3(0.3, -0.5, 1.2);
  motion.motion[1].pose.position_m = Vec3(0.01, 0.0, 0.02);
  const Pose goal = motion.motion[1].pose.toPose();
  Scene scene(config);
  for (int step = 0; step < 10; ++step)
  {
    ASSERT_TRUE(scene.step().converged) << step;
  }
  const Points x = positionsOf(scene);
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    EXPECT_LT((x[i] - goal * scene.tissues()[0].rest.nodes[i]).norm(), 1e-6 * kSide);
  }
}

TEST_P(MassSpringTissue, FliesAndSpinsWithoutLoss)
{
  SceneConfig config = heldBlock(folder_, GetParam(), {});
  config.tissues[0].fixed.clear();
  config.tissues[0].keyframes.clear();
  config.solver = SolverConfig();
  Scene scene(config);
  const TetMesh& rest = scene.tissues()[0].rest;
  std::vector<double> masses(rest.nodes.size(), 0.0);
  for (const Tet& tet : rest.tets)
  {
    for (const Index node : tet)
    {
      const Points& p = rest.nodes;
      masses[node] += 1000.0 / 24.0 * signedVolume6(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]);
    }
  }
  const auto motionOf = [&](const Points& x, const Points& v) {
    Eigen::Matrix<double, 6, 1> motion = Eigen::Matrix<double, 6, 1>::Zero();
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      motion.head<3>() += masses[i] * v[i];
      motion.tail<3>() += masses[i] * x[i].cross(v[i]);
    }
    return motion;
  };
  Points v;
  for (const Vec3& p : rest.nodes)
  {
    v.push_back(Vec3(0.1, 0.0, 0.05) + Vec3(3.0, -5.0, 20.0).cross(p) +
                5.0 * p.z() * Vec3::UnitZ());
  }
  const auto before = motionOf(rest.nodes, v);
  scene.setMotion(0, rest.nodes, v);
  Snapshot snapshot;
  for (int step = 0; step < 50; ++step)
  {
    ASSERT_TRUE(scene.step().converged) << step;
  }
  scene.fillSnapshot(snapshot);
  const auto after = motionOf(snapshot.tissues[0].positions, snapshot.tissues[0].velocities);
  EXPECT_LT((after - before).norm(), 1e-10 * before.norm());
}

TEST_P(MassSpringTissue, StandsBesideALawOfStrainInOneBody)
{
  TetMesh mesh = makeBox({4, 4, 4}, {kSide, kSide, kSide});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
  {
    mesh.tags[t] = t < mesh.tets.size() / 2 ? 1 : 2;
  }
  PoseConfig goal;
  goal.position_m.z() = -0.003;
  SceneConfig config = heldBlock(folder_, GetParam(), goal);
  config.tissues[0].mesh.file = saved(folder_, "parts.msh", mesh);
  config.tissues[0].material.model = MaterialModel::neo_hookean;
  config.outputs.stress = true;
  RegionConfig region;
  region.tag = 2;
  region.model = MaterialModel::mass_spring;
  config.tissues[0].regions.push_back(region);
  Scene scene(config);
  for (int step = 0; step < 10; ++step)
  {
    ASSERT_TRUE(scene.step().converged) << step;
  }
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const std::vector<float>& stress = snapshot.tissues[0].von_mises;
  ASSERT_EQ(stress.size(), mesh.tets.size());
  for (const float s : stress)
  {
    EXPECT_GT(s, 100.0f);  // a tenth shorter at 5 kPa
    EXPECT_LT(s, 2000.0f);
  }
}

struct Refusal
{
  const char* material;  ///< and what stands beside it
  const char* complaint;
};

TEST(MassSpringKeys, RefusesKeysThatSpringsDoNotHave)
{
  const Refusal refusals[] = {
      {"{model: mass_spring, young_modulus_pa: 3000, poisson_ratio: 0.2, density_kg_per_m3: 1060}",
       "tissues[0].material: has poisson_ratio 0.2, must be at least 0.25 with model mass_spring"},
      {"{model: mass_spring, young_modulus_pa: 3000, poisson_ratio: 0.3, density_kg_per_m3: 1060, "
       "stiffening: 1}",
       "tissues[0].material.stiffening = 1, is for model exponential, which is not asked for"},
      {"{model: mass_spring, young_modulus_pa: 3000, poisson_ratio: 0.3, density_kg_per_m3: 1060, "
       "stiffness_damping_s: 0.1}",
       "tissues[0].material: has relaxation or stiffness_damping_s, which model mass_spring "
       "doesn't take"},
      {"{young_modulus_pa: 3000, poisson_ratio: 0.3, density_kg_per_m3: 1060, "
       "relaxation: [{relative_modulus: 1, relaxation_time_s: 1}]}\n"
       "    regions: [{tag: 2, model: mass_spring}]",
       "tissues[0].material: has relaxation or stiffness_damping_s, which model mass_spring "
       "doesn't take"},
      {"{model: mass_spring, young_modulus_pa: 3000, poisson_ratio: 0.3, density_kg_per_m3: 1060}\n"
       "    element: tet10",
       "tissues[0].element = tet10, must be tet4 with model mass_spring"},
      {"{young_modulus_pa: 3000, poisson_ratio: 0, density_kg_per_m3: 1060}\n"
       "    regions: [{tag: 2, model: mass_spring}]",
       "tissues[0].regions[0]: has poisson_ratio 0, must be at least 0.25 with model mass_spring"}};
  const SceneFolder folder;
  for (const Refusal& refusal : refusals)
  {
    const std::string text = std::string(
                                 "tissues:\n  - name: liver\n"
                                 "    mesh: {file: mesh.msh, length_unit: m}\n"
                                 "    material: ") +
                             refusal.material + "\n";
    EXPECT_EQ(complaintAbout(folder, text), std::string("DIR/scene.yaml: ") + refusal.complaint);
  }
}

}  // namespace
}  // namespace soft_tissue
