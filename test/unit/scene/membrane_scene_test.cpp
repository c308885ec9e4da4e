#include <gtest/gtest.h>

#include "scene_folder.h"
#include "soft_tissue_sim/base/error.h"
#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr const char* kBoth = R"(
tissues:
  - name: liver
    mesh: {file: mesh.msh, length_unit: m}
    material: {young_modulus_pa: 3000, poisson_ratio: 0.45, density_kg_per_m3: 1060}
membranes:
  - name: skin
    mesh: {file: mesh.msh, length_unit: mm}
    pose: {position_m: [0, 0, 1]}
    velocity_m_per_s: [0, 0, -1]
    material: {young_modulus_pa: 1e6, poisson_ratio: 0.4, density_kg_per_m3: 1000}
    thickness_m: 0.002
    fixed: [{box_m: [[-1, -1, -1], [1, 1, 1]]}]
tools:
  - {name: ball, shape: {sphere: {radius_m: 0.01}}}
contacts:
  - {between: [liver, skin], response: point}
  - {between: [ball, skin]}
)";

TEST(MembraneConfig, IsReadAndStandsBeforeWhatItTouches)
{
  SceneFolder folder;
  const SceneConfig scene = loadSceneConfig(folder.write("scene.yaml", kBoth), nullptr);
  ASSERT_EQ(scene.membranes.size(), 1u);
  const soft_tissue::MembraneConfig& skin = scene.membranes[0];
  EXPECT_EQ(skin.name, "skin");
  EXPECT_EQ(skin.mesh.metres_per_unit, 0.001);
  EXPECT_EQ(skin.pose.position_m, Vec3(0, 0, 1));
  EXPECT_EQ(skin.velocity_m_per_s, Vec3(0, 0, -1));
  EXPECT_EQ(skin.material.young_modulus_pa, 1e6);
  EXPECT_EQ(skin.thickness_m, 0.002);
  EXPECT_EQ(skin.fixed.size(), 1u);
  EXPECT_EQ(scene.contacts[0].tissue, "skin");
  EXPECT_EQ(scene.contacts[0].other, "liver");
  EXPECT_EQ(scene.contacts[1].tissue, "skin");
  EXPECT_EQ(scene.contacts[1].other, "ball");
  EXPECT_EQ(scene.softBody(0).name, "liver");
  EXPECT_EQ(scene.softBody(1).name, "skin");
}

/** A sheet of two triangles, 100 mm wide, and a tool above it. */
SceneConfig sheetScene(const ScratchFolder& folder, double tool_radius_m)
{
  SceneConfig config;
  config.file = "sheet scene";
  soft_tissue::MembraneConfig sheet;
  sheet.name = "sheet";
  sheet.mesh.file = folder.path("sheet.stl");
  saveStl(sheet.mesh.file, makeSheet({1, 1}, {0.1, 0.1}, SheetPattern::irregular));
  sheet.material = {MaterialModel::neo_hookean, 2e5, 0.45, 1000.0};
  sheet.thickness_m = 0.001;
  sheet.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(0.01, 1.0, 1.0)});
  config.membranes.push_back(sheet);
  PoseConfig start;
  start.position_m = Vec3(0.05, 0.05, 0.1);
  addTool(config, SphereShape{tool_radius_m}, start, Response::segment);
  config.contacts[0].tissue = "sheet";
  return config;
}

std::string complaintAbout(const SceneConfig& config)
{
  try
  {
    const Scene scene(config);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(MembraneScene, HasNodesAndASurfaceButNoTets)
{
  const ScratchFolder folder;
  Scene scene(sheetScene(folder, 0.01));
  ASSERT_EQ(scene.tissues().size(), 1u);
  EXPECT_TRUE(scene.tissues()[0].isMembrane());
  EXPECT_EQ(scene.tissues()[0].surface.triangles.size(), 2u);
  EXPECT_EQ(scene.tissues()[0].fixed_nodes.size(), 2u);
  scene.step();
  Snapshot state;
  scene.fillSnapshot(state);
  EXPECT_EQ(state.tissues[0].positions.size(), 4u);
  EXPECT_EQ(state.report.min_det_f, 1.0);
}

TEST(MembraneScene, WeighsDensityTimesThicknessTimesArea)
{
  const ScratchFolder folder;
  SceneConfig config = sheetScene(folder, 0.01);
  config.membranes[0].fixed.clear();
  config.contacts.clear();
  config.time_step_s = 0.01;
  config.solver.tolerance = 1e-10;
  Scene scene(config);
  scene.step();
  Snapshot state;
  scene.fillSnapshot(state);
  for (const Vec3& v : state.tissues[0].velocities)
  {
    EXPECT_NEAR((v - Vec3(0.0, 0.0, -0.0981)).norm(), 0.0, 1e-9);  // it falls as a whole
  }
}

TEST(MembraneScene, RejectsWhatItCantDo)
{
  const ScratchFolder folder;
  EXPECT_EQ(complaintAbout(sheetScene(folder, 0.001)),  // STL has single precision
            "sheet scene: membranes[0] 'sheet' has edges of 141.421358 mm, must be at most "
            "64.000000 mm for contact with 'tool'");
  SceneConfig free = sheetScene(folder, 0.01);
  free.membranes[0].fixed.clear();
  free.solver.stepper = Stepper::quasi_static;
  EXPECT_EQ(complaintAbout(free),
            "sheet scene: membranes[0].fixed is empty: a quasi-static membrane needs a fixed "
            "region");
  SceneConfig tets = sheetScene(folder, 0.01);
  tets.membranes[0].mesh.file = folder.path("box.msh");
  saveGmsh(tets.membranes[0].mesh.file, makeBox({1, 1, 1}, {0.1, 0.1, 0.1}));
  EXPECT_EQ(complaintAbout(tets),
            tets.membranes[0].mesh.file + " has tets, a membrane must be a mesh of triangles");
  SceneConfig flat = sheetScene(folder, 0.01);
  saveStl(flat.membranes[0].mesh.file,
          {{Vec3::Zero(), Vec3(0.1, 0.0, 0.0), Vec3(0.05, 0.0, 0.0)}, {{0, 1, 2}}});
  EXPECT_EQ(complaintAbout(flat),
            flat.membranes[0].mesh.file + ": triangle 0 has no area, can't be simulated");
}

}  // namespace
}  // namespace soft_tissue::test
