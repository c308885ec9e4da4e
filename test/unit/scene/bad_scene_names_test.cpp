#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bad_scene.h"

namespace soft_tissue
{
namespace
{
const char* const kCapsule = "{capsule: {radius_m: 0.004, length_m: 0.02}}";

std::vector<BadScene> badNames()
{
  return {
      {"name: liver", "name: 2nd_liver",
       "tissues[0].name = 2nd_liver, must be a name: a letter, then letters, digits or _"},
      {"name: liver", "name: my liver",
       "tissues[0].name = my liver, must be a name: a letter, then letters, digits or _"},
      {"name: liver", "name: l\xc3\xa9ver",
       "tissues[0].name = l\xc3\xa9ver, must be a name: a letter, then letters, digits or _"},
      {"name: kidney", "name: liver",
       "tissues[1].name = liver, is tissues[0].name too, must be new"},
      {"name: hook", "name: probe", "tools[1].name = probe, is tools[0].name too, must be new"},
      {"outputs:", "obstacles: [{name: probe, octomap: {file: mesh.msh}}]\noutputs:",
       "obstacles[0].name = probe, is tools[0].name too, must be new"},
      {"contacts:",
       "obstacles: [{name: table, octomap: {file: mesh.msh}}]\ncontacts:\n"
       "  - {between: [table, hook]}",
       "contacts[0].between = [table, hook], must have a tissue or a membrane; tools and "
       "obstacles don't touch each other"},
      {"outputs:", "obstacles: [{name: table}]\noutputs:",
       "obstacles[0].octomap: missing, must be a map"},
      {"outputs:", "obstacles: [{name: table, octomap: {file: mesh.msh, depth: 17}}]\noutputs:",
       "obstacles[0].octomap.depth = 17, must be in [1, 16]"},
      {"outputs:",
       "obstacles: [{name: table, octomap: {file: mesh.msh, unknown: maybe}}]\noutputs:",
       "obstacles[0].octomap.unknown = maybe, must be one of free, occupied"},
      {"outputs:", "obstacles: [{name: table, octomap: {topic: octomap_in}}]\noutputs:",
       "obstacles[0].octomap.resolution_m: missing, must be given with topic"},
      {"outputs:",
       "obstacles: [{name: table, octomap: {topic: octomap_in, resolution_m: 0}}]\noutputs:",
       "obstacles[0].octomap.resolution_m = 0, must be in (0, 10]"},
      {"outputs:",
       "obstacles: [{name: table, octomap: {topic: /a b, resolution_m: 0.01}}]\noutputs:",
       "obstacles[0].octomap.topic = /a b, must be a relative topic name: names joined by /"},
      {"outputs:",
       "obstacles: [{name: table, octomap: {file: mesh.msh, resolution_m: 0.01}}]\noutputs:",
       "obstacles[0].octomap.resolution_m = 0.01, is for topic; a file has its own"},
      {"outputs:", "obstacles: [{name: table, octomap: {depth: 16}}]\noutputs:",
       "obstacles[0].octomap: has none, must have exactly one of file, topic"},
      {"{stress: false}", "{octomap: {}}",
       "outputs.octomap.resolution_m: missing, must be a number in [1e-04, 1]"},
      {"{stress: false}", "{octomap: {resolution_m: 0}}",
       "outputs.octomap.resolution_m = 0, must be in [1e-04, 1]"},
      {"{stress: false}", "{octomap: {resolution_m: 0.01, rate_hz: -1}}",
       "outputs.octomap.rate_hz = -1, must be in [0, 1000]"},
      {"name: hook", "name: kidney", "tools[1].name = kidney, is tissues[1].name too, must be new"},
      {"name: kidney", "name: tissue_pairs",
       "tissues[1].name = tissue_pairs, is what markers of contacts are called, must be another "
       "name"},
      {"name: hook", "name: tissue_pairs",
       "tools[1].name = tissue_pairs, is what markers of contacts are called, must be another "
       "name"},
      {"[liver, probe]", "[lever, probe]",
       "contacts[0].between = [lever, probe], there is no tissue, membrane, tool or obstacle "
       "'lever'"},
      {"[liver, probe]", "[liver, proof]",
       "contacts[0].between = [liver, proof], there is no tissue, membrane, tool or obstacle "
       "'proof'"},
      {"[liver, probe]", "[hook, probe]",
       "contacts[0].between = [hook, probe], must have a tissue or a membrane; tools and "
       "obstacles don't touch each other"},
      {"[liver, probe]", "liver",
       "contacts[0].between = liver, must be a list of 2 names: a soft body and "
       "what it touches"},
      {"[liver, probe]", "[liver, probe, hook]",
       "contacts[0].between = [liver, probe, hook], must be a list of 2 names: a soft "
       "body and what it touches"},
      {"outputs:", "  - between: [kidney, liver]\n  - between: [liver, kidney]\noutputs:",
       "contacts[2].between = [liver, kidney], is the pair of contacts[1] too, must be new"},
      {"outputs:", "  - between: [probe, liver]\noutputs:",
       "contacts[1].between = [probe, liver], is the pair of contacts[0] too, must be new"},
      {"{tag: 2, young_modulus_pa: 3.0e4}",
       "{tag: 2, young_modulus_pa: 1}, {tag: 2, poisson_ratio: 0}",
       "tissues[0].regions[1].tag = 2, is the tag of regions[0], must be new"},
      {"stress: false", "stress: maybe", "outputs.stress = maybe, must be one of true, false"},
      {"linear: auto", "linear: fastest",
       "solver.linear = fastest, must be one of auto, pcg, cholesky"},
      {"linear: auto", "stepper: rk4",
       "solver.stepper = rk4, must be one of implicit_euler, bdf2, quasi_static"},
      {"response: segment", "response: [segment]",
       "contacts[0].response = [segment], must be one of point, segment, auto"},
      {"    field: {method: cffm}", "    element: tet20",
       "tissues[0].element = tet20, must be one of tet4, tet4_anp, tet10, auto"},
      {"{method: cffm}", "{method: magic}",
       "tissues[0].field.method = magic, must be one of exact_marching, cffm, cpfm, "
       "grid"},
      {"{method: cffm}", "{method: cffm, grid_points: 40}",
       "tissues[0].field.grid_points = 40, is for method grid, which is not asked for"},
      {"{method: cffm}", "{method: grid, grid_points: 7}",
       "tissues[0].field.grid_points = 7, must be in [8, 400]"},
      {"{method: cffm}", "{refresh: never}",
       "tissues[0].field.refresh = never, must be one of carried, lazy, full"},
      {"{young_modulus_pa: 3000,", "{model: jelly, young_modulus_pa: 3000,",
       "tissues[0].material.model = jelly, must be one of neo_hookean, neo_hookean_log, "
       "exponential, corotated, st_venant_kirchhoff, linear, mass_spring"},
      {"length_unit: m}\n    material: {young_modulus_pa: 3000",
       "length_unit: inch}\n    material: "
       "{young_modulus_pa: 3000",
       "tissues[0].mesh.length_unit = inch, must be one of m, cm, mm, um"},
      {"topic: servo_cp", "topic: /servo_cp",
       "tools[1].pose_source.topic = /servo_cp, must be a relative topic name: names joined by /"},
      {"topic: servo_cp", "topic: arm//servo_cp",
       "tools[1].pose_source.topic = arm//servo_cp, must be a relative topic name: names joined by "
       "/"},
      {"topic: servo_cp", "tf: /tip",
       "tools[1].pose_source.tf = /tip, must be a tf frame: no leading / and no blanks"},
      {kCapsule, "{urdf: {file: mesh.msh, links: []}}",
       "tools[0].shape.urdf.links: is an empty list, must have at least 1"},
      {kCapsule, "{urdf: {file: mesh.msh}}",
       "tools[0].shape.urdf: has none, must have exactly one of link, links"},
  };
}

std::vector<BadScene> badFiles()
{
  return {
      {"mesh: {file: mesh.msh, length_unit: m}\n", "mesh: {file: gone.msh, length_unit: m}\n",
       "tissues[0].mesh.file = gone.msh, no such file: DIR/gone.msh"},
      {"mesh: {file: mesh.msh, length_unit: m}\n", "mesh: {file: a/../gone.msh, length_unit: m}\n",
       "tissues[0].mesh.file = a/../gone.msh, no such file: DIR/gone.msh"},
      {"mesh: {file: mesh.msh, length_unit: m}\n", "mesh: {file: folder, length_unit: m}\n",
       "tissues[0].mesh.file = folder, is a folder or device, must be a file: DIR/folder"},
      {"mesh: {file: mesh.msh, length_unit: m}\n", "mesh: {file: '', length_unit: m}\n",
       "tissues[0].mesh.file = '', must be a file: path, package://PACKAGE/FILE or file:///PATH"},
      {"mesh: {file: mesh.msh, length_unit: m}\n", "mesh: {file: [mesh.msh], length_unit: m}\n",
       "tissues[0].mesh.file = [mesh.msh], must be a file: path, package://PACKAGE/FILE or "
       "file:///PATH"},
      {"mesh: {file: mesh.msh", "mesh: {file: http://example.org/a.msh",
       "tissues[0].mesh.file = http://example.org/a.msh, must be a path, package://PACKAGE/FILE or "
       "file:///PATH"},
      {"mesh: {file: mesh.msh", "mesh: {file: file://mesh.msh",
       "tissues[0].mesh.file = file://mesh.msh, must be file:///ABSOLUTE/PATH"},
      {"mesh: {file: mesh.msh", "mesh: {file: package://mesh.msh",
       "tissues[0].mesh.file = package://mesh.msh, must be package://PACKAGE/FILE"},
      {"mesh: {file: mesh.msh", "mesh: {file: package://no_such_package/a.msh",
       "tissues[0].mesh.file = package://no_such_package/a.msh, ROS finds no package "
       "'no_such_package'"},
      {"outputs:", "obstacles: [{name: table, octomap: {file: gone.bt}}]\noutputs:",
       "obstacles[0].octomap.file = gone.bt, no such file: DIR/gone.bt"},
      {kCapsule, "{mesh: {file: gone.stl, length_unit: m}}",
       "tools[0].shape.mesh.file = gone.stl, no such file: DIR/gone.stl"},
      {kCapsule, "{urdf: {file: gone.urdf, link: tip}}",
       "tools[0].shape.urdf.file = gone.urdf, no such file: DIR/gone.urdf"},
      {"outputs:", "materials: gone.yaml\noutputs:",
       "materials = gone.yaml, no such file: DIR/gone.yaml"},
  };
}

#define NOT_AVAILABLE "not available in version 0.1; see docs/limits.md"

#define SKIN                                                          \
  "membranes: [{name: skin, mesh: {file: mesh.msh, length_unit: m}, " \
  "material: {young_modulus_pa: 1e6, poisson_ratio: 0.4, density_kg_per_m3: 1000"

std::vector<BadScene> badMembranes()
{
  return {
      {"outputs:", "membranes: [{name: skin}]\noutputs:",
       "membranes[0].mesh: missing, must be a map"},
      {"outputs:", SKIN "}}]\noutputs:",
       "membranes[0].thickness_m: missing, must be a number in (0, 0.1]"},
      {"outputs:", SKIN "}, thickness_m: 0.2}]\noutputs:",
       "membranes[0].thickness_m = 0.2, must be in (0, 0.1]"},
      {"outputs:", SKIN ", model: corotated}, thickness_m: 0.001}]\noutputs:",
       "membranes[0].material.model = corotated, is for tissues, a membrane has a law of its own"},
      {"outputs:", SKIN "}, thickness_m: 0.001, field: {method: cffm}}]\noutputs:",
       "membranes[0].field: unknown key, did you mean 'fixed'? Known: name, mesh, pose, "
       "velocity_m_per_s, material, "
       "thickness_m, fixed, keyframes"},
      {"contacts:", SKIN "}, thickness_m: 0.001}]\ncontacts:\n  - {between: [skin, skin]}",
       "contacts[0].between = [skin, skin], must have a tissue, tool or obstacle; membranes don't "
       "touch each other"},
      {"outputs:",
       "membranes: [{name: kidney, mesh: {file: mesh.msh, length_unit: m}, material: "
       "{preset: liver}, thickness_m: 0.001}]\noutputs:",
       "membranes[0].name = kidney, is tissues[1].name too, must be new"},
  };
}

std::vector<BadScene> badLaws()
{
  return {
      {"friction: 0.1", "damping_s_per_m: -1",
       "contacts[0].damping_s_per_m = -1, must be in [0, 1e+06]"},
      {"friction: 0.1", "law: hertz",
       "contacts[0].law = hertz, must be one of pressure, fisher2001, marchal2004"},
      {"friction: 0.1", "penalty: 5",
       "contacts[0].penalty = 5, is for laws fisher2001 and marchal2004, which aren't asked for"},
      {"stiffness_pa_per_m: 1.0e7", "law: marchal2004",
       "contacts[0].penalty: missing, must be given with law marchal2004"},
      {"friction: 0.1", "law: marchal2004, penalty: 5",
       "contacts[0].stiffness_pa_per_m = 1.0e7, is for law pressure; this one has a penalty"},
      {"stiffness_pa_per_m: 1.0e7", "law: fisher2001, penalty: 5",
       "contacts[0].law = fisher2001, knows nodes alone, must stand with response: point"},
  };
}

std::vector<BadScene> notAvailable()
{
  return {
      {"linear: auto", "linear: multigrid",
       "solver.linear = multigrid, " NOT_AVAILABLE "; must be auto, pcg, cholesky"},
  };
}

class BadSceneNamesTest : public testing::TestWithParam<BadScene>
{
 protected:
  SceneFolder folder_;
};

TEST_P(BadSceneNamesTest, IsAnsweredWithFileKeyValueAndWhatIsAllowed)
{
  const std::string text = replaced(kGood, GetParam().from, GetParam().to);
  ASSERT_NE(text, kGood);
  EXPECT_EQ(complaintAbout(folder_, text), std::string("DIR/scene.yaml: ") + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(Names, BadSceneNamesTest, testing::ValuesIn(badNames()));
INSTANTIATE_TEST_SUITE_P(Files, BadSceneNamesTest, testing::ValuesIn(badFiles()));
INSTANTIATE_TEST_SUITE_P(Membranes, BadSceneNamesTest, testing::ValuesIn(badMembranes()));
INSTANTIATE_TEST_SUITE_P(Laws, BadSceneNamesTest, testing::ValuesIn(badLaws()));
INSTANTIATE_TEST_SUITE_P(NotAvailable, BadSceneNamesTest, testing::ValuesIn(notAvailable()));

TEST(BadSceneResolverTest, PackagesCantBeFoundWithoutAResolver)
{
  const SceneFolder folder;
  const std::string text = replaced(kGood, "file: mesh.msh", "file: package://pkg/mesh.msh");
  try
  {
    loadSceneConfig(folder.write("scene.yaml", text), nullptr);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(replaced(error.what(), folder.path(), "DIR"),
              "DIR/scene.yaml: tissues[0].mesh.file = package://pkg/mesh.msh, package:// names "
              "can't be found without ROS; use a path");
  }
}

}  // namespace
}  // namespace soft_tissue
