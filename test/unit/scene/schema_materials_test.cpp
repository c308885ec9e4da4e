#include <gtest/gtest.h>

#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "bad_scene.h"

namespace soft_tissue
{
namespace
{
const char* const kScene = R"(
materials: my_materials.yaml
tissues:
  - name: liver
    mesh: {file: mesh.msh, length_unit: m}
    material: {preset: jelly}
)";

const char* const kMaterials = R"(
presets:
  - name: wood
    model: neo_hookean
    young_modulus_pa: 1.0e9
    young_modulus_range_pa: [1.0e8, 1.0e10]
    young_modulus_source: nobody 1900
    poisson_ratio: 0.3
    poisson_ratio_source: nobody 1901
    density_kg_per_m3: 600
    density_range_kg_per_m3: [500, 700]
    density_source: nobody 1902
  - name: jelly
    model: corotated
    young_modulus_pa: 2000
    young_modulus_range_pa: [1000, 3000]
    young_modulus_source: nobody 1903
    poisson_ratio: 0.48
    poisson_ratio_source: nobody 1904
    density_kg_per_m3: 1010
    density_range_kg_per_m3: [1000, 1020]
    density_source: nobody 1905
)";

class SchemaMaterialsTest : public testing::Test
{
 protected:
  SchemaMaterialsTest() { folder_.write("my_materials.yaml", kMaterials); }

  MaterialConfig load(const std::string& scene)
  {
    return loadSceneConfig(folder_.write("scene.yaml", scene), findPackage).tissues.at(0).material;
  }

  SceneFolder folder_;
};

TEST_F(SchemaMaterialsTest, PresetGivesAllValues)
{
  const MaterialConfig material = load(kScene);
  EXPECT_EQ(material.model, MaterialModel::corotated);
  EXPECT_EQ(material.young_modulus_pa, 2000.0);
  EXPECT_EQ(material.poisson_ratio, 0.48);
  EXPECT_EQ(material.density_kg_per_m3, 1010.0);
}

TEST_F(SchemaMaterialsTest, ValuesBesideAPresetReplaceThePresets)
{
  const MaterialConfig stiff = load(replaced(kScene, "jelly", "jelly, young_modulus_pa: 500"));
  EXPECT_EQ(stiff.young_modulus_pa, 500.0);
  EXPECT_EQ(stiff.poisson_ratio, 0.48);
  EXPECT_EQ(stiff.model, MaterialModel::corotated);
  const MaterialConfig other = load(replaced(
      kScene, "jelly", "jelly, model: neo_hookean, poisson_ratio: 0.1, density_kg_per_m3: 1"));
  EXPECT_EQ(other.model, MaterialModel::neo_hookean);
  EXPECT_EQ(other.young_modulus_pa, 2000.0);
  EXPECT_EQ(other.poisson_ratio, 0.1);
  EXPECT_EQ(other.density_kg_per_m3, 1.0);
}

TEST_F(SchemaMaterialsTest, StiffeningComesFromTheMaterialTheRegionOrThePreset)
{
  const MaterialConfig asked = load(replaced(kScene, "jelly",
                                             "jelly, model: exponential, "
                                             "stiffening: 3"));
  EXPECT_EQ(asked.model, MaterialModel::exponential);
  EXPECT_EQ(asked.stiffening, 3.0);
  EXPECT_FALSE(load(kScene).stiffening.has_value());
  folder_.write("my_materials.yaml",
                replaced(kMaterials, "model: corotated",
                         "model: exponential\n    stiffening: 5\n    stiffening_source: me"));
  EXPECT_EQ(load(kScene).stiffening, 5.0);
  const std::string region = "}\n    regions: [{tag: 1, model: exponential, stiffening: 4}]\n";
  const SceneConfig scene = loadSceneConfig(
      folder_.write("scene.yaml", replaced(kScene, "jelly}\n", "wood" + region)), findPackage);
  EXPECT_EQ(scene.tissues[0].material.model, MaterialModel::neo_hookean);
  EXPECT_EQ(scene.tissues[0].regions[0].model, MaterialModel::exponential);
  EXPECT_EQ(scene.tissues[0].regions[0].stiffening, 4.0);
}

TEST_F(SchemaMaterialsTest, DampingAndRelaxationComeFromTheMaterialOrThePreset)
{
  const MaterialConfig none = load(kScene);
  EXPECT_EQ(none.mass_damping_per_s, 0.0);
  EXPECT_EQ(none.stiffness_damping_s, 0.0);
  EXPECT_TRUE(none.relaxation.empty());
  folder_.write("my_materials.yaml",
                replaced(kMaterials, "model: corotated",
                         "model: corotated\n    mass_damping_per_s: 2\n"
                         "    stiffness_damping_s: 0.03\n    relaxation: [{relative_modulus: 0.5, "
                         "relaxation_time_s: 7}]\n    viscosity_source: me"));
  const MaterialConfig preset = load(kScene);
  EXPECT_EQ(preset.mass_damping_per_s, 2.0);
  EXPECT_EQ(preset.stiffness_damping_s, 0.03);
  ASSERT_EQ(preset.relaxation.size(), 1U);
  EXPECT_EQ(preset.relaxation[0].relative_modulus, 0.5);
  EXPECT_EQ(preset.relaxation[0].relaxation_time, 7.0);
  const MaterialConfig asked =
      load(replaced(kScene, "jelly", "jelly, mass_damping_per_s: 0, relaxation: []"));
  EXPECT_EQ(asked.mass_damping_per_s, 0.0);
  EXPECT_EQ(asked.stiffness_damping_s, 0.03);
  EXPECT_TRUE(asked.relaxation.empty());
  EXPECT_EQ(complaintAbout(folder_, std::string(kScene) + "solver: {stepper: quasi_static}\n"),
            "DIR/scene.yaml: tissues[0].material: has mass_damping_per_s, which needs stepper "
            "implicit_euler");
  EXPECT_EQ(complaintAbout(folder_, replaced(replaced(kScene, "tissues:", "membranes:"), "jelly}",
                                             "jelly}\n    thickness_m: 0.001")),
            "DIR/scene.yaml: membranes[0].material: has relaxation or stiffness_damping_s, which "
            "are for tissues, not for membranes");
}

TEST_F(SchemaMaterialsTest, EveryModelHasItsWord)
{
  std::set<MaterialModel> found;
  for (const char* word : {"neo_hookean", "neo_hookean_log", "exponential, stiffening: 1",
                           "corotated", "st_venant_kirchhoff", "linear"})
  {
    found.insert(load(replaced(kScene, "jelly", std::string("jelly, model: ") + word)).model);
  }
  EXPECT_EQ(found, std::set<MaterialModel>(std::begin(kMaterialModels), std::end(kMaterialModels)));
}

TEST_F(SchemaMaterialsTest, ModelsThatDoNotTakeAMaterial)
{
  const auto complaint = [&](const std::string& keys) {
    return complaintAbout(folder_, replaced(kScene, "{preset: jelly}", keys));
  };
  EXPECT_EQ(complaint("{preset: jelly, model: neo_hookean_log, poisson_ratio: -0.1}"),
            "DIR/scene.yaml: tissues[0].material: has poisson_ratio -0.1, must be at least 0 with "
            "model neo_hookean_log");
  EXPECT_EQ(complaint("{preset: jelly, model: exponential}"),
            "DIR/scene.yaml: tissues[0].material.stiffening: missing, must be given with model "
            "exponential");
  EXPECT_EQ(complaint("{preset: jelly, stiffening: 2}"),
            "DIR/scene.yaml: tissues[0].material.stiffening = 2, is for model exponential, which "
            "is not asked for");
  EXPECT_EQ(complaint("{preset: jelly, model: exponential, stiffening: 0}"),
            "DIR/scene.yaml: tissues[0].material.stiffening = 0, must be in [0.001, 100]");
  EXPECT_EQ(complaint("{preset: jelly}\n    regions: [{tag: 1, model: exponential}]"),
            "DIR/scene.yaml: tissues[0].regions[0].stiffening: missing, must be given with model "
            "exponential");
  EXPECT_EQ(complaint("{preset: jelly}\n    regions: [{tag: 1, stiffening: 1}]"),
            "DIR/scene.yaml: tissues[0].regions[0].stiffening = 1, is for model exponential, which "
            "is not asked for");
  EXPECT_EQ(complaint("{preset: jelly, model: neo_hookean_log}\n"
                      "    regions: [{tag: 1, poisson_ratio: -0.2}]"),
            "DIR/scene.yaml: tissues[0].regions[0]: has poisson_ratio -0.2, must be at least 0 "
            "with model neo_hookean_log");
}

TEST_F(SchemaMaterialsTest, SceneTellsWhereItsPresetsComeFrom)
{
  const SceneConfig scene = loadSceneConfig(folder_.write("scene.yaml", kScene), findPackage);
  EXPECT_EQ(scene.materials, folder_.path() + "/my_materials.yaml");
}

TEST_F(SchemaMaterialsTest, PresetsThatComeWithThePackageAreSound)
{
  const std::string scene = replaced(kScene, "materials: my_materials.yaml", "");
  for (const char* name :
       {"liver", "kidney", "brain", "fat", "muscle", "gallbladder", "silicone_ecoflex_0030"})
  {
    const MaterialConfig material = load(replaced(scene, "jelly", name));
    EXPECT_GT(material.young_modulus_pa, 0.0) << name;
    EXPECT_LT(material.poisson_ratio, 0.5) << name;
    EXPECT_GT(material.density_kg_per_m3, 800.0) << name;
    EXPECT_LT(material.density_kg_per_m3, 1200.0) << name;
  }
}

TEST_F(SchemaMaterialsTest, UnknownPreset)
{
  EXPECT_EQ(complaintAbout(folder_, replaced(kScene, "jelly", "jello")),
            "DIR/scene.yaml: tissues[0].material.preset = jello, must be one of wood, jelly "
            "(presets of my_materials.yaml)");
}

TEST_F(SchemaMaterialsTest, PackagePresetsNeedAResolver)
{
  const std::string scene = replaced(kScene, "materials: my_materials.yaml", "");
  try
  {
    loadSceneConfig(folder_.write("scene.yaml", scene), nullptr);
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_EQ(replaced(error.what(), folder_.path(), "DIR"),
              "DIR/scene.yaml: tissues[0].material.preset = jelly, needs "
              "package://soft_tissue_sim/config/materials.yaml: package:// names can't be found "
              "without ROS; use a path");
  }
}

/** One change to the materials file, and its complaint after that file's name. */
class BadMaterialsTest : public testing::TestWithParam<BadScene>
{};

TEST_P(BadMaterialsTest, IsAnsweredWithFileKeyValueAndRange)
{
  const SceneFolder folder;
  const std::string text = replaced(kMaterials, GetParam().from, GetParam().to);
  ASSERT_NE(text, kMaterials);
  folder.write("my_materials.yaml", text);
  EXPECT_EQ(complaintAbout(folder, kScene),
            std::string("DIR/my_materials.yaml: ") + GetParam().complaint);
}

INSTANTIATE_TEST_SUITE_P(
    Presets, BadMaterialsTest,
    testing::ValuesIn(std::vector<BadScene>{
        {"name: wood", "name: jelly",
         "presets[1].name = jelly, is the name of presets[0], must be new"},
        {"name: wood", "name: w d",
         "presets[0].name = w d, must be a name: a letter, then letters, digits or _"},
        {"    model: corotated\n", "",
         "presets[1].model: missing, must be a word: neo_hookean, neo_hookean_log, exponential, "
         "corotated, st_venant_kirchhoff, linear, mass_spring"},
        {"    density_source: nobody 1905\n", "",
         "presets[1].density_source: missing, must be a text"},
        {"density_source: nobody 1905", "density_source: ''",
         "presets[1].density_source = '', must be a text"},
        {"young_modulus_pa: 2000", "young_modulus_pa: 3001",
         "presets[1].young_modulus_pa = 3001, must be in presets[1].young_modulus_range_pa = "
         "[1000, 3000]"},
        {"density_kg_per_m3: 1010", "density_kg_per_m3: 999",
         "presets[1].density_kg_per_m3 = 999, must be in presets[1].density_range_kg_per_m3 = "
         "[1000, 1020]"},
        {"[1000, 3000]", "[3000, 1000]",
         "presets[1].young_modulus_range_pa = [3000, 1000], must be [least, greatest]"},
        {"[1000, 3000]", "[0, 3000]",
         "presets[1].young_modulus_range_pa[0] = 0, must be in (0, 1e+12]"},
        {"[1000, 3000]", "2000",
         "presets[1].young_modulus_range_pa = 2000, must be a list of 2 numbers"},
        {"poisson_ratio: 0.48", "poisson_ratio: 0.5",
         "presets[1].poisson_ratio = 0.5, must be in (-1, 0.5)"},
        {"poisson_ratio_source: nobody 1904", "poisson_ratio_sauce: nobody 1904",
         "presets[1].poisson_ratio_sauce: unknown key, did you mean 'poisson_ratio_source'? Known: "
         "name, model, young_modulus_pa, young_modulus_range_pa, young_modulus_source, "
         "poisson_ratio, poisson_ratio_source, density_kg_per_m3, density_range_kg_per_m3, "
         "density_source, stiffening, stiffening_source, mass_damping_per_s, stiffness_damping_s, "
         "relaxation, viscosity_source"},
        {"model: corotated", "model: corotated\n    stiffness_damping_s: 0.1",
         "presets[1].viscosity_source: missing, must be given with stiffness_damping_s"},
        {"model: corotated", "model: exponential",
         "presets[1].stiffening: missing, must be given with model exponential"},
        {"model: corotated", "model: exponential\n    stiffening: 3",
         "presets[1].stiffening_source: missing, must be given with stiffening"},
        {"presets:", "preset:", "preset: unknown key, did you mean 'presets'? Known: presets"},
        {"name: wood", "name: [", "line 5, column 21: end of sequence flow not found"},
    }));

}  // namespace
}  // namespace soft_tissue
