#include "bad_scene.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace soft_tissue
{
namespace
{
std::vector<BadScene> badNumbers()
{
  return {
      {"time_step_s: 0.005", "time_step_s: 0", "time_step_s = 0, must be in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: 1.5", "time_step_s = 1.5, must be in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: five", "time_step_s = five, must be a number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: '0.005'",
       "time_step_s = 0.005, must be a number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: 5 ms", "time_step_s = 5 ms, must be a number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: 0,005",
       "time_step_s = 0,005, must be a number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s:", "time_step_s = nothing, must be a number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: ''", "time_step_s = '', must be a number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: .nan",
       "time_step_s = .nan, must be a finite number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: nan",
       "time_step_s = nan, must be a finite number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: -.inf",
       "time_step_s = -.inf, must be a finite number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: 1e999",
       "time_step_s = 1e999, does not fit a double; must be a number in (0, 1]"},
      {"time_step_s: 0.005", "time_step_s: {value: 1}",
       "time_step_s = {value: 1}, must be a number in (0, 1]"},
      {"[0, 0, -9.81]", "[0, 0, -9810]",
       "gravity_m_per_s2 = [0, 0, -9810], must be of magnitude at most 1000"},
      {"[0, 0, -9.81]", "[0, -9.81]", "gravity_m_per_s2 = [0, -9.81], must be a list of 3 numbers"},
      {"[0, 0, -9.81]", "-9.81", "gravity_m_per_s2 = -9.81, must be a list of 3 numbers"},
      {"[0, 0, -9.81]", "[0, 0, down]", "gravity_m_per_s2[2] = down, must be a number"},
      {"[0, 0, -9.81]", "[0, .inf, 0]", "gravity_m_per_s2[1] = .inf, must be a finite number"},
      {"tolerance: 1.0e-3", "tolerance: 0.2", "solver.tolerance = 0.2, must be in (0, 0.1]"},
      {"tolerance: 1.0e-3", "tolerance: 0", "solver.tolerance = 0, must be in (0, 0.1]"},
      {"linear: auto", "sleep: {speed_m_per_s: 0}",
       "solver.sleep.speed_m_per_s = 0, must be in (0, 1]"},
      {"linear: auto", "sleep: {acceleration_m_per_s2: 1.5}",
       "solver.sleep.acceleration_m_per_s2 = 1.5, must be in (0, 1]"},
      {"linear: auto", "sleep: {after_s: -1}", "solver.sleep.after_s = -1, must be in [0, 1000]"},
      {"linear: auto", "stepper: quasi_static, sleep: {}",
       "solver.sleep: must not stand with stepper quasi_static, which has no speeds"},
      {"max_iterations: 20", "budget_ms: 0", "solver.budget_ms = 0, must be in (0, 1e+06]"},
      {"max_iterations: 20", "budget_ms: fast",
       "solver.budget_ms = fast, must be a number in (0, 1e+06]"},
      {"max_iterations: 20", "max_iterations: 0",
       "solver.max_iterations = 0, must be in [1, 1000]"},
      {"max_iterations: 20", "max_iterations: 1001",
       "solver.max_iterations = 1001, must be in [1, 1000]"},
      {"max_iterations: 20", "max_iterations: 2.5",
       "solver.max_iterations = 2.5, must be a whole number in [1, 1000]"},
      {"young_modulus_pa: 3000", "young_modulus_pa: 0",
       "tissues[0].material.young_modulus_pa = 0, must be in (0, 1e+12]"},
      {"young_modulus_pa: 9000", "young_modulus_pa: -9000",
       "tissues[1].material.young_modulus_pa = -9000, must be in (0, 1e+12]"},
      {"young_modulus_pa: 3.0e4", "young_modulus_pa: -1",
       "tissues[0].regions[0].young_modulus_pa = -1, must be in (0, 1e+12]"},
      {"poisson_ratio: 0.45", "poisson_ratio: 0.45, mass_damping_per_s: -1",
       "tissues[0].material.mass_damping_per_s = -1, must be in [0, 10000]"},
      {"poisson_ratio: 0.45", "poisson_ratio: 0.45, stiffness_damping_s: 2000",
       "tissues[0].material.stiffness_damping_s = 2000, must be in [0, 1000]"},
      {"poisson_ratio: 0.45",
       "poisson_ratio: 0.45, relaxation: [{relative_modulus: 0, relaxation_time_s: 1}]",
       "tissues[0].material.relaxation[0].relative_modulus = 0, must be in (0, 1000]"},
      {"poisson_ratio: 0.45", "poisson_ratio: 0.45, relaxation: [{relative_modulus: 1}]",
       "tissues[0].material.relaxation[0].relaxation_time_s: missing, must be a number in (0, "
       "1e+06]"},
      {"poisson_ratio: 0.45", "poisson_ratio: 0.7",
       "tissues[0].material.poisson_ratio = 0.7, must be in (-1, 0.5)"},
      {"poisson_ratio: 0.4,", "poisson_ratio: 0.5,",
       "tissues[1].material.poisson_ratio = 0.5, must be in (-1, 0.5)"},
      {"density_kg_per_m3: 1060", "density_kg_per_m3: 0",
       "tissues[0].material.density_kg_per_m3 = 0, must be in (0, 1e+05]"},
      {"tag: 2", "tag: -2", "tissues[0].regions[0].tag = -2, must be in [0, 2147483647]"},
      {"[[-0.2, -0.2, -0.01]", "[[-0.2, 0.3, -0.01]",
       "tissues[0].fixed[0].box_m[0][1] = 0.3, must be at most tissues[0].fixed[0].box_m[1][1] = "
       "0.2"},
      {"[[-0.2, -0.2, -0.01]", "[[-1073741824, -0.2, -0.01]",
       "tissues[0].fixed[0].box_m[0][0] = -1073741824, must be in [-1000, 1000]"},
      {"[[-0.2, -0.2, -0.01], [0.2, 0.2, 0.002]]", "[0, 1]",
       "tissues[0].fixed[0].box_m[0] = 0, must be a list of 3 numbers"},
      {"[[-0.2, -0.2, -0.01], [0.2, 0.2, 0.002]]", "[[0, 0, 0]]",
       "tissues[0].fixed[0].box_m = [[0, 0, 0]], must be a list of 2 corners, each a list of 3 "
       "numbers"},
      {"radius_m: 0.004", "radius_m: -0.004",
       "tools[0].shape.capsule.radius_m = -0.004, must be in (0, 10)"},
      {"length_m: 0.02", "length_m: 20",
       "tools[0].shape.capsule.length_m = 20, must be in (0, 10)"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}", "{sphere: {radius_m: 0}}",
       "tools[0].shape.sphere.radius_m = 0, must be in (0, 10)"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}", "{box: {size_m: [1, 0, 1]}}",
       "tools[0].shape.box.size_m[1] = 0, must be in (0, 10)"},
      {"scale: [1, 1, 1]", "scale: [1, 1, 0]",
       "tools[1].shape.mesh.scale[2] = 0, must be in [-1000, 1000] and not 0"},
      {"position_m: [0, 0, 0]", "position_m: [0, 0, 1e9]",
       "tools[0].pose_source.keyframes[1].position_m[2] = 1e9, must be in [-1000, 1000]"},
      {"position_m: [0, 0, 0]", "position_m: [0, 0, 0], rotation_rpy_rad: [90, 0, 0]",
       "tools[0].pose_source.keyframes[1].rotation_rpy_rad[0] = 90, must be in [-6.2832, 6.2832]"},
      {"time_s: 1", "time_s: 0",
       "tools[0].pose_source.keyframes[1].time_s = 0, must be above "
       "tools[0].pose_source.keyframes[0].time_s = 0"},
      {"time_s: 1", "time_s: -1",
       "tools[0].pose_source.keyframes[1].time_s = -1, must be in [0, 1e+06]"},
      {"1.0e7", "0.5", "contacts[0].stiffness_pa_per_m = 0.5, must be in [1, 1e+15]"},
      {"1.0e7", "2.0e15", "contacts[0].stiffness_pa_per_m = 2.0e15, must be in [1, 1e+15]"},
      {"1.0e7", "hard", "contacts[0].stiffness_pa_per_m = hard, must be a number in [1, 1e+15]"},
      {"friction: 0.1", "friction: -0.1", "contacts[0].friction = -0.1, must be in [0, 2]"},
      {"friction: 0.1", "max_penetration_m: 0",
       "contacts[0].max_penetration_m = 0, must be in (0, 1)"},
      {"friction: 0.1", "friction: 2.1", "contacts[0].friction = 2.1, must be in [0, 2]"},
  };
}

std::vector<BadScene> badKeys()
{
  return {
      {"    material: {young_modulus_pa: 3000", "    materail: {young_modulus_pa: 3000",
       "tissues[0].materail: unknown key, did you mean 'material'? Known: name, mesh, pose, "
       "velocity_m_per_s, material, element, regions, fixed, keyframes, field"},
      {"young_modulus_pa: 3000", "young_modulus_kpa: 3",
       "tissues[0].material.young_modulus_kpa: unknown key, did you mean 'young_modulus_pa'? "
       "Known: model, preset, young_modulus_pa, poisson_ratio, density_kg_per_m3, stiffening, "
       "mass_damping_per_s, stiffness_damping_s, relaxation"},
      {"density_kg_per_m3: 1060", "density: 1060",
       "tissues[0].material.density: unknown key, did you mean 'density_kg_per_m3'? Known: model, "
       "preset, young_modulus_pa, poisson_ratio, density_kg_per_m3, stiffening, "
       "mass_damping_per_s, stiffness_damping_s, relaxation"},
      {"time_step_s: 0.005", "time_step_ms: 5",
       "time_step_ms: unknown key, did you mean 'time_step_s'? Known: time_step_s, "
       "gravity_m_per_s2, materials, solver, tissues, membranes, tools, obstacles, contacts, "
       "outputs"},
      {"outputs:", "banana:",
       "banana: unknown key. Known: time_step_s, gravity_m_per_s2, materials, solver, tissues, "
       "membranes, tools, obstacles, contacts, outputs"},
      {"outputs:", "time_step_s: 0.01\noutputs:", "time_step_s: stands twice, must stand once"},
      {"length_unit: m}", "length_unit: m, file: other.msh}",
       "tissues[0].mesh.file: stands twice, must stand once"},
      {"outputs:", "[a, b]: 1\noutputs:", "has a key that is not a word"},
      {"  - name: liver\n    mesh", "  - mesh",
       "tissues[0].name: missing, must be a name: a letter, then letters, digits or _"},
      {"    mesh: {file: mesh.msh, length_unit: m}\n", "",
       "tissues[0].mesh: missing, must be a map"},
      {"mesh: {file: mesh.msh, length_unit: m}\n", "mesh: {file: mesh.msh}\n",
       "tissues[0].mesh.length_unit: missing, must be a word: m, cm, mm, um"},
      {"poisson_ratio: 0.45, ", "",
       "tissues[0].material.poisson_ratio: missing, must be given where there is no preset"},
      {"time_s: 1, ", "",
       "tools[0].pose_source.keyframes[1].time_s: missing, must be a number in [0, 1e+06]"},
      {"between: [liver, probe], ", "",
       "contacts[0].between: missing, must be a list of 2 names: a soft body and what it "
       "touches, in any order"},
      {"tissues:", "tissues: liver\nx:",
       "x: unknown key. Known: time_step_s, gravity_m_per_s2, materials, solver, tissues, "
       "membranes, tools, obstacles, contacts, outputs"},
      {"solver: {tolerance: 1.0e-3, max_iterations: 20, linear: auto}", "solver: fast",
       "solver = fast, must be a map of keys: stepper, tolerance, max_iterations, linear, "
       "budget_ms, sleep"},
      {"outputs: {stress: false}", "outputs: [stress]",
       "outputs = [stress], must be a map of keys: stress, octomap"},
      {"{tag: 2, young_modulus_pa: 3.0e4}", "{tag: 2}",
       "tissues[0].regions[0]: changes nothing, must have more keys than tag"},
      {"[{tag: 2, young_modulus_pa: 3.0e4}]", "{tag: 2, young_modulus_pa: 3.0e4}",
       "tissues[0].regions = {tag: 2, young_modulus_pa: 3.0e4}, must be a list"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}", "{}",
       "tools[0].shape: has none, must have exactly one of sphere, capsule, box, mesh, urdf"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}",
       "{sphere: {radius_m: 1}, box: {size_m: [1, 1, 1]}}",
       "tools[0].shape: has sphere, box, must have exactly one of sphere, capsule, box, mesh, "
       "urdf"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}", "[]",
       "tools[0].shape: is an empty list, must have at least 1"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}", "{cone: {}}",
       "tools[0].shape.cone: unknown key. Known: sphere, capsule, box, mesh, urdf, origin"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}",
       "{urdf: {file: mesh.msh, link: a}, origin: {}}",
       "tools[0].shape.origin: must not stand beside urdf, which has its own"},
      {"{capsule: {radius_m: 0.004, length_m: 0.02}}",
       "[{urdf: {file: mesh.msh, link: a}}, {sphere: {radius_m: 1}}]",
       "tools[0].shape: must have no other shape beside urdf"},
      {"{topic: servo_cp}", "{topic: servo_cp, tf: tip}",
       "tools[1].pose_source: has topic, tf, must have exactly one of keyframes, topic, twist, "
       "tf, marker, base"},
      {"{topic: servo_cp}", "{keyframes: []}",
       "tools[1].pose_source.keyframes: is an empty list, must have at least 1"},
  };
}

class BadSceneTest : public testing::TestWithParam<BadScene>
{
 protected:
  SceneFolder folder_;
};

TEST_P(BadSceneTest, IsAnsweredWithFileKeyValueAndRange)
{
  const std::string text = replaced(kGood, GetParam().from, GetParam().to);
  ASSERT_NE(text, kGood);
  EXPECT_EQ(complaintAbout(folder_, text), std::string("DIR/scene.yaml: ") + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(Numbers, BadSceneTest, testing::ValuesIn(badNumbers()));
INSTANTIATE_TEST_SUITE_P(Keys, BadSceneTest, testing::ValuesIn(badKeys()));

TEST(GoodSceneTest, IsNotComplainedAbout)
{
  EXPECT_EQ(complaintAbout(SceneFolder(), kGood), "no complaint");
}

}  // namespace
}  // namespace soft_tissue
