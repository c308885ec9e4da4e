#include "soft_tissue_sim/scene/config.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene_folder.h"

namespace soft_tissue
{
namespace
{
const char* const kSmallest = R"(
tissues:
  - name: liver
    mesh: {file: mesh.msh, length_unit: mm}
    material: {young_modulus_pa: 3000, poisson_ratio: 0.45, density_kg_per_m3: 1060}
)";

const char* const kFullest = R"(
time_step_s: 0.002
gravity_m_per_s2: [1, -2, 3.5]
solver: {stepper: quasi_static, tolerance: 1.0e-4, max_iterations: 7, linear: cholesky}
tissues:
  - name: liver
    mesh: {file: mesh.msh, length_unit: cm}
    pose: {position_m: [0.1, 0.2, 0.3], rotation_rpy_rad: [0.4, 0.5, 0.6]}
    material: {model: corotated, young_modulus_pa: 3e3, poisson_ratio: 0.45,
               density_kg_per_m3: 1060}
    regions:
      - {tag: 2, young_modulus_pa: 3.0e4}
      - {tag: 3, poisson_ratio: -0.1, density_kg_per_m3: 900}
    fixed:
      - box_m: [[-0.2, -0.2, -0.01], [0.2, 0.2, 0.002]]
      - {box_m: [[0, 0, 0], [0, 0, 0]]}
    field: {method: cffm, depth: interpolated, refresh: full}
  - name: kidney
    mesh: {file: ./folder/../mesh.msh, length_unit: um}
    material: {young_modulus_pa: 1, poisson_ratio: 0, density_kg_per_m3: 1}
tools:
  - name: ball
    shape: {sphere: {radius_m: 0.004}, origin: {position_m: [0, 0, 1]}}
    initial_pose: {position_m: [0, 0, 2], rotation_rpy_rad: [0, 0, 3]}
    pose_source: {topic: arm/servo_cp}
  - name: rod
    shape: {capsule: {radius_m: 0.005, length_m: 0.02}}
    pose_source: {tf: psm1/tool_tip}
  - name: pair
    shape:
      - box: {size_m: [0.1, 0.2, 0.3]}
      - mesh: {file: mesh.msh, length_unit: m, scale: [1, -1, 2]}
    pose_source:
      keyframes:
        - {time_s: 0, position_m: [0, 0, 0.1]}
        - {time_s: 1.5, position_m: [0, 0, 0.05], rotation_rpy_rad: [0, 1, 0]}
  - name: forceps
    shape: {urdf: {file: mesh.msh, links: [jaw]}}
contacts:
  - {between: [liver, ball]}
  - {between: [rod, kidney], response: point, stiffness_pa_per_m: 2.0e6, friction: 0.3}
  - {between: [liver, forceps], stiffness_pa_per_m: auto}
outputs: {stress: true}
membranes: []
obstacles: []
)";

class ConfigTest : public testing::Test
{
 protected:
  SceneConfig load(const std::string& text)
  {
    return loadSceneConfig(folder_.write("scene.yaml", text), nullptr);
  }
  SceneFolder folder_;
};

TEST_F(ConfigTest, WhatAFileLeavesOutIsTheDefault)
{
  const SceneConfig scene = load(kSmallest);
  const SceneConfig defaults;
  EXPECT_EQ(scene.file, folder_.path() + "/scene.yaml");
  EXPECT_EQ(scene.time_step_s, defaults.time_step_s);
  EXPECT_EQ(scene.gravity_m_per_s2, defaults.gravity_m_per_s2);
  EXPECT_EQ(scene.materials, defaults.materials);
  EXPECT_EQ(scene.solver.stepper, defaults.solver.stepper);
  EXPECT_EQ(scene.solver.tolerance, defaults.solver.tolerance);
  EXPECT_EQ(scene.solver.max_iterations, defaults.solver.max_iterations);
  EXPECT_EQ(scene.solver.linear, defaults.solver.linear);
  EXPECT_TRUE(scene.tools.empty());
  EXPECT_TRUE(scene.contacts.empty());
  EXPECT_FALSE(scene.outputs.stress);
  const TissueConfig& tissue = scene.tissues.at(0);
  EXPECT_EQ(tissue.pose.position_m, Vec3(0, 0, 0));
  EXPECT_TRUE(tissue.regions.empty());
  EXPECT_TRUE(tissue.fixed.empty());
  EXPECT_EQ(tissue.material.model, MaterialConfig().model);
  EXPECT_EQ(tissue.field.method, FieldConfig().method);
  EXPECT_EQ(tissue.field.depth, FieldConfig().depth);
  EXPECT_EQ(tissue.field.refresh, FieldConfig().refresh);
}

TEST_F(ConfigTest, SolverAndOutputsArrive)
{
  const SceneConfig scene = load(kFullest);
  EXPECT_EQ(scene.time_step_s, 0.002);
  EXPECT_EQ(scene.gravity_m_per_s2, Vec3(1, -2, 3.5));
  EXPECT_EQ(scene.solver.stepper, Stepper::quasi_static);
  EXPECT_EQ(scene.solver.tolerance, 1e-4);
  EXPECT_EQ(scene.solver.max_iterations, 7);
  EXPECT_EQ(scene.solver.linear, LinearSolverKind::cholesky);
  EXPECT_TRUE(scene.outputs.stress);
}

TEST_F(ConfigTest, LimitsOfSleepArrive)
{
  const std::string plain = "solver: {stepper: quasi_static, ";
  const auto loaded = [&](const std::string& solver) {
    std::string text = kFullest;
    text.replace(text.find(plain), plain.size(), "solver: {" + solver);
    return load(text).solver;
  };
  const SolverConfig solver =
      loaded("stepper: bdf2, sleep: {speed_m_per_s: 2e-3, acceleration_m_per_s2: 0.2}, ");
  EXPECT_EQ(solver.stepper, Stepper::bdf2);
  ASSERT_TRUE(solver.sleep.has_value());
  EXPECT_EQ(solver.sleep->speed_m_per_s, 2e-3);
  EXPECT_EQ(solver.sleep->acceleration_m_per_s2, 0.2);
  EXPECT_EQ(solver.sleep->after_s, SleepConfig().after_s);
  EXPECT_FALSE(loaded("sleep: never, ").sleep.has_value());
  EXPECT_FALSE(load(kFullest).solver.sleep.has_value());
}

TEST_F(ConfigTest, TissuesArrive)
{
  const SceneConfig scene = load(kFullest);
  ASSERT_EQ(scene.tissues.size(), 2U);
  const TissueConfig& liver = scene.tissues[0];
  EXPECT_EQ(liver.name, "liver");
  EXPECT_EQ(liver.mesh.file, folder_.path() + "/mesh.msh");
  EXPECT_EQ(liver.mesh.metres_per_unit, 0.01);
  EXPECT_EQ(liver.pose.position_m, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(liver.pose.rotation_rpy_rad, Vec3(0.4, 0.5, 0.6));
  EXPECT_EQ(liver.material.model, MaterialModel::corotated);
  EXPECT_EQ(liver.material.young_modulus_pa, 3000.0);
  EXPECT_EQ(liver.material.poisson_ratio, 0.45);
  EXPECT_EQ(liver.material.density_kg_per_m3, 1060.0);
  ASSERT_EQ(liver.regions.size(), 2U);
  EXPECT_EQ(liver.regions[0].tag, 2);
  EXPECT_EQ(liver.regions[0].young_modulus_pa, 3e4);
  EXPECT_FALSE(liver.regions[0].poisson_ratio.has_value());
  EXPECT_FALSE(liver.regions[0].density_kg_per_m3.has_value());
  EXPECT_EQ(liver.regions[1].poisson_ratio, -0.1);
  EXPECT_EQ(liver.regions[1].density_kg_per_m3, 900.0);
  ASSERT_EQ(liver.fixed.size(), 2U);
  EXPECT_EQ(liver.fixed[0].min, Vec3(-0.2, -0.2, -0.01));
  EXPECT_EQ(liver.fixed[0].max, Vec3(0.2, 0.2, 0.002));
  EXPECT_EQ(liver.field.depth, DepthKind::interpolated);
  EXPECT_EQ(liver.field.refresh, FieldRefresh::full);
  EXPECT_EQ(scene.tissues[1].mesh.file, folder_.path() + "/mesh.msh");
  EXPECT_EQ(scene.tissues[1].mesh.metres_per_unit, 1e-6);
}

TEST_F(ConfigTest, ToolShapesArrive)
{
  const SceneConfig scene = load(kFullest);
  ASSERT_EQ(scene.tools.size(), 4U);
  ASSERT_EQ(scene.tools[0].shapes.size(), 1U);
  EXPECT_EQ(std::get<SphereShape>(scene.tools[0].shapes[0].geometry).radius_m, 0.004);
  EXPECT_EQ(scene.tools[0].shapes[0].origin.position_m, Vec3(0, 0, 1));
  EXPECT_EQ(scene.tools[0].initial_pose.position_m, Vec3(0, 0, 2));
  EXPECT_EQ(scene.tools[0].initial_pose.rotation_rpy_rad, Vec3(0, 0, 3));
  const auto& capsule = std::get<CapsuleShape>(scene.tools[1].shapes.at(0).geometry);
  EXPECT_EQ(capsule.radius_m, 0.005);
  EXPECT_EQ(capsule.length_m, 0.02);
  ASSERT_EQ(scene.tools[2].shapes.size(), 2U);
  EXPECT_EQ(std::get<BoxShape>(scene.tools[2].shapes[0].geometry).size_m, Vec3(0.1, 0.2, 0.3));
  const auto& mesh = std::get<MeshShape>(scene.tools[2].shapes[1].geometry);
  EXPECT_EQ(mesh.mesh.file, folder_.path() + "/mesh.msh");
  EXPECT_EQ(mesh.mesh.metres_per_unit, 1.0);
  EXPECT_EQ(mesh.scale, Vec3(1, -1, 2));
  EXPECT_FALSE(scene.tools[2].urdf.has_value());
  EXPECT_TRUE(scene.tools[3].shapes.empty());
  ASSERT_TRUE(scene.tools[3].urdf.has_value());
  EXPECT_EQ(scene.tools[3].urdf->file, folder_.path() + "/mesh.msh");
  EXPECT_EQ(scene.tools[3].urdf->links, std::vector<std::string>{"jaw"});
  EXPECT_EQ(scene.tools[3].urdf->frame, "");
}

TEST_F(ConfigTest, PoseSourcesArrive)
{
  const SceneConfig scene = load(kFullest);
  EXPECT_EQ(scene.tools[0].pose_source.kind, PoseSourceConfig::Kind::topic);
  EXPECT_EQ(scene.tools[0].pose_source.name, "arm/servo_cp");
  EXPECT_EQ(scene.tools[1].pose_source.kind, PoseSourceConfig::Kind::tf);
  EXPECT_EQ(scene.tools[1].pose_source.name, "psm1/tool_tip");
  const PoseSourceConfig& moved = scene.tools[2].pose_source;
  EXPECT_EQ(moved.kind, PoseSourceConfig::Kind::keyframes);
  ASSERT_EQ(moved.keyframes.size(), 2U);
  EXPECT_EQ(moved.keyframes[0].time_s, 0.0);
  EXPECT_EQ(moved.keyframes[0].pose.position_m, Vec3(0, 0, 0.1));
  EXPECT_EQ(moved.keyframes[0].pose.rotation_rpy_rad, Vec3(0, 0, 0));
  EXPECT_EQ(moved.keyframes[1].time_s, 1.5);
  EXPECT_EQ(moved.keyframes[1].pose.rotation_rpy_rad, Vec3(0, 1, 0));
  EXPECT_EQ(scene.tools[3].pose_source.kind, PoseSourceConfig().kind);
  EXPECT_EQ(scene.tools[3].pose_source.name, PoseSourceConfig().name);
}

TEST_F(ConfigTest, ContactsArriveInEitherOrder)
{
  const SceneConfig scene = load(kFullest);
  ASSERT_EQ(scene.contacts.size(), 3U);
  EXPECT_EQ(scene.contacts[0].tissue, "liver");
  EXPECT_EQ(scene.contacts[0].other, "ball");
  EXPECT_EQ(scene.contacts[0].response, ContactConfig().response);
  EXPECT_EQ(scene.contacts[0].friction, ContactConfig().friction);
  EXPECT_FALSE(scene.contacts[0].stiffness_pa_per_m.has_value());
  EXPECT_EQ(scene.contacts[1].tissue, "kidney");
  EXPECT_EQ(scene.contacts[1].other, "rod");
  EXPECT_EQ(scene.contacts[1].response, Response::point);
  EXPECT_EQ(scene.contacts[1].stiffness_pa_per_m, 2e6);
  EXPECT_EQ(scene.contacts[1].friction, 0.3);
  EXPECT_FALSE(scene.contacts[2].stiffness_pa_per_m.has_value());
}

TEST_F(ConfigTest, EachLengthUnitIsThatManyMetres)
{
  const std::pair<const char*, double> units[] = {
      {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"um", 0.000001}};
  for (const auto& [unit, metres] : units)
  {
    const SceneConfig scene =
        load(replaced(kSmallest, "length_unit: mm", std::string("length_unit: ") + unit));
    EXPECT_EQ(scene.tissues[0].mesh.metres_per_unit, metres) << unit;
  }
}

TEST_F(ConfigTest, FilesAreFoundByPathUriAndPackage)
{
  const std::string absolute = folder_.path() + "/mesh.msh";
  EXPECT_EQ(load(replaced(kSmallest, "mesh.msh", absolute)).tissues[0].mesh.file, absolute);
  EXPECT_EQ(load(replaced(kSmallest, "mesh.msh", "file://" + absolute)).tissues[0].mesh.file,
            absolute);
  const std::string text = replaced(kSmallest, "mesh.msh", "package://soft_tissue_sim/package.xml");
  EXPECT_EQ(loadSceneConfig(folder_.write("s.yaml", text), findPackage).tissues[0].mesh.file,
            SOURCE_DIR "/package.xml");
}

TEST_F(ConfigTest, RelativeFilesStartAtTheSceneFileWhereverTheProgramRuns)
{
  folder_.write("scene.yaml", kSmallest);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path() + "/folder");
  const SceneConfig scene = loadSceneConfig("../scene.yaml", nullptr);
  std::filesystem::current_path(before);
  EXPECT_EQ(scene.tissues[0].mesh.file, folder_.path() + "/mesh.msh");
  EXPECT_EQ(scene.file, "../scene.yaml");
}

TEST(PoseConfigTest, RollPitchYawTurnAboutFixedAxes)
{
  PoseConfig config;
  config.position_m = Vec3(1, 2, 3);
  config.rotation_rpy_rad = Vec3(M_PI / 2, M_PI / 2, 0);
  // Roll takes y to z, pitch then takes z to x; roll leaves x, pitch then takes x to -z.
  const Pose pose = config.toPose();
  EXPECT_LT((pose * Vec3(0, 1, 0) - Vec3(2, 2, 3)).norm(), 1e-15);
  EXPECT_LT((pose * Vec3(1, 0, 0) - Vec3(1, 2, 2)).norm(), 1e-15);
  config.rotation_rpy_rad = Vec3(0, M_PI / 2, M_PI / 2);
  // Pitch takes z to x, yaw then takes x to y.
  EXPECT_LT((config.toPose() * Vec3(0, 0, 1) - Vec3(1, 3, 3)).norm(), 1e-15);
}

}  // namespace
}  // namespace soft_tissue
