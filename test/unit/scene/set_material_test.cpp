#include <gtest/gtest.h>

#include <filesystem>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/scene/material_change.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
class SetMaterial : public testing::Test
{
 protected:
  /** A heavy block whose upper half is a region, under a ball. */
  SceneConfig block()
  {
    TetMesh mesh = makeBox({4, 4, 4}, {0.06, 0.06, kBlockTop});
    mesh.tags.assign(mesh.tets.size(), 1);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    {
      if (mesh.nodes[mesh.tets[t][0]].z() > 0.5 * kBlockTop)
      {
        mesh.tags[t] = 2;
      }
    }
    SceneConfig config = tissueScene(saved(folder_, "block.msh", mesh));
    config.tissues[0].pose.position_m = Vec3(-0.03, -0.03, 0.0);
    config.tissues[0].regions = {{2, {}, 8000.0, {}, {}, {}}};
    config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    fixBelow(config, 1e-6);
    addTool(config, SphereShape{0.01}, {Vec3(0.0, 0.0, kBlockTop + 0.0095), {}}, Response::segment);
    config.contacts[0].stiffness_pa_per_m.reset();
    return config;
  }

  static std::string complaint(Scene& scene, const MaterialChange& change)
  {
    try
    {
      scene.setMaterial(0, change);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "none";
  }

  ScratchFolder folder_;
};

/** Hash after some steps down with the tool. */
std::uint64_t after(Scene& scene)
{
  for (int k = 0; k < 10; ++k)
  {
    scene.setToolTarget(0, Pose(Eigen::Translation3d(0.0, 0.0, kBlockTop + 0.009 - 0.0001 * k)));
    scene.step();
  }
  return scene.stateHash();
}

// Before anything has happened a material that is set is as good as one from the file.
TEST_F(SetMaterial, ActsAsIfTheSceneHadBeenMadeWithIt)
{
  for (const ElementKind element : {ElementKind::tet4, ElementKind::tet10})
  {
    SceneConfig config = block();
    config.tissues[0].element = element;
    config.tissues[0].material.mass_damping_per_s = 2.0;
    config.tissues[0].material.relaxation = {{0.5, 0.1}};
    Scene set(config), plain(config);
    set.setMaterial(0, {{}, 12000.0, 0.3, 1500.0, {}});
    set.setMaterial(0, {2, 30000.0, {}, 900.0, {}});
    const std::uint64_t without = after(plain);
    MaterialConfig& material = config.tissues[0].material;
    material.young_modulus_pa = 12000.0;
    material.poisson_ratio = 0.3;
    material.density_kg_per_m3 = 1500.0;
    config.tissues[0].regions[0].young_modulus_pa = 30000.0;
    config.tissues[0].regions[0].density_kg_per_m3 = 900.0;
    Scene made(config);
    const std::uint64_t expected = after(made);
    EXPECT_EQ(after(set), expected);
    EXPECT_NE(expected, without);
    EXPECT_EQ(set.config().tissues[0].material.young_modulus_pa, 12000.0);
  }
}

TEST_F(SetMaterial, OfAMembraneToo)
{
  SceneConfig config = block();
  MembraneConfig skin;
  static_cast<SoftBodyConfig&>(skin) = config.tissues[0];
  skin.name = "skin";
  skin.mesh.file = folder_.path("skin.stl");
  saveStl(skin.mesh.file, makeSheet({6, 6}, {0.05, 0.05}, SheetPattern::irregular));
  skin.pose.position_m = Vec3(-0.025, -0.025, 0.05);
  skin.fixed.clear();
  skin.thickness_m = 0.001;
  config.membranes.push_back(skin);
  addPair(config, "skin", "tool", Response::segment);
  Scene set(config);
  set.setMaterial(1, {{}, 3e4, 0.2, 2000.0, {}});
  MaterialConfig& material = config.membranes[0].material;
  material.young_modulus_pa = 3e4;
  material.poisson_ratio = 0.2;
  material.density_kg_per_m3 = 2000.0;
  Scene made(config);
  EXPECT_EQ(after(set), after(made));
  EXPECT_THROW(set.setMaterial(1, {2, 3e4, {}, {}, {}}), Error);
}

TEST_F(SetMaterial, InTheCourseOfTimeLeadsToTheNewBalance)
{
  SceneConfig config = block();
  config.solver.stepper = Stepper::quasi_static;
  config.solver.tolerance = 1e-8;
  config.solver.max_iterations = 100;
  Scene set(config);
  after(set);
  set.setMaterial(0, {{}, 20000.0, {}, {}, {}});
  config.tissues[0].material.young_modulus_pa = 20000.0;
  Scene made(config);
  after(made);
  after(set);
  Snapshot a, b;
  set.fillSnapshot(a);
  made.fillSnapshot(b);
  for (std::size_t i = 0; i < a.tissues[0].positions.size(); ++i)
  {
    EXPECT_LT((a.tissues[0].positions[i] - b.tissues[0].positions[i]).norm(), 1e-7);
  }
}

TEST_F(SetMaterial, IsPartOfTheState)
{
  const SceneConfig config = block();
  Scene set(config), fresh(config);
  after(set);
  set.setMaterial(0, {{}, 12000.0, {}, {}, {}});
  set.step();
  set.saveState(folder_.path("state"));
  fresh.loadState(folder_.path("state"));
  EXPECT_EQ(fresh.config().tissues[0].material.young_modulus_pa, 12000.0);
  EXPECT_EQ(after(fresh), after(set));
}

TEST_F(SetMaterial, RefusesWhatAFileMustNotHave)
{
  Scene scene(block()), untouched(block());
  const std::string where = "small scene: tissues[0] 'tissue': ";
  EXPECT_EQ(complaint(scene, {{}, 0.0, {}, {}, {}}),
            where + "young_modulus_pa = 0, must be in (0, 1e+12]");
  EXPECT_EQ(complaint(scene, {{}, 1000.0, 0.5, {}, {}}),
            where + "poisson_ratio = 0.5, must be in (-1, 0.5)");
  EXPECT_EQ(complaint(scene, {{}, {}, {}, 1e6, {}}),
            where + "density_kg_per_m3 = 1e+06, must be in (0, 1e+05]");
  EXPECT_EQ(complaint(scene, {{}, {}, {}, {}, 2.0}),
            where + "stiffening = 2, is for model exponential, which this is not of");
  EXPECT_EQ(complaint(scene, {2, {}, {}, {}, 200.0}),
            where + "stiffening = 200, must be in [0.001, 100]");
  EXPECT_EQ(complaint(scene, {7, 1000.0, {}, {}, {}}),
            where + "region = 7, must be one that the scene file names: 2");
  EXPECT_THROW(scene.setMaterial(1, {}), std::out_of_range);
  EXPECT_EQ(after(scene), after(untouched));
  std::filesystem::remove(folder_.path("block.msh"));
  EXPECT_NE(complaint(scene, {{}, 1000.0, {}, {}, {}}).find("block.msh"), std::string::npos);
  scene.step();
  untouched.step();
  EXPECT_EQ(scene.stateHash(), untouched.stateHash());
}

}  // namespace
}  // namespace soft_tissue::test
