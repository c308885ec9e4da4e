#include "soft_tissue_sim/scene/scene_parameter.h"

#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
SceneConfig scene()
{
  SceneConfig config;
  config.file = "liver.yaml";
  TissueConfig liver;
  liver.name = "liver";
  liver.material.young_modulus_pa = 3000.0;
  liver.material.poisson_ratio = 0.45;
  RegionConfig lump;
  lump.tag = 2;
  lump.young_modulus_pa = 3e4;
  liver.regions = {lump};
  config.tissues = {liver};
  MembraneConfig sheet;
  sheet.name = "sheet";
  sheet.material.young_modulus_pa = 1e6;
  config.membranes = {sheet};
  ContactConfig contact;
  contact.tissue = "liver";
  contact.other = "probe";
  contact.stiffness_pa_per_m = 1e7;
  config.contacts = {contact};
  return config;
}

TEST(SceneParameter, isReadAndSetByName)
{
  SceneConfig config = scene();
  const std::pair<const char*, double> known[] = {
      {"liver/young_modulus_pa", 3000.0},      {"liver/poisson_ratio", 0.45},
      {"liver/2/young_modulus_pa", 3e4},       {"sheet/young_modulus_pa", 1e6},
      {"liver/probe/stiffness_pa_per_m", 1e7}, {"liver/probe/friction", 0.0}};
  for (const auto& [name, value] : known)
  {
    const SceneParameter parameter(config, name);
    EXPECT_EQ(parameter.value(config), value) << name;
    parameter.set(config, 0.125);
    EXPECT_EQ(parameter.value(config), 0.125) << name;
  }
  EXPECT_EQ(*config.tissues[0].regions[0].young_modulus_pa, 0.125);
  EXPECT_EQ(*config.contacts[0].stiffness_pa_per_m, 0.125);
}

TEST(SceneParameter, variesInProportionOrBetweenBounds)
{
  EXPECT_TRUE(SceneParameter(scene(), "liver/young_modulus_pa").isLogarithmic());
  const SceneParameter ratio(scene(), "liver/poisson_ratio");
  EXPECT_FALSE(ratio.isLogarithmic());
  EXPECT_EQ(ratio.lower(), 0.0);
  EXPECT_LT(ratio.upper(), 0.5);
}

TEST(SceneParameter, mustBeInTheScene)
{
  for (const char* name :
       {"young_modulus_pa", "kidney/young_modulus_pa", "liver/colour", "liver/3/young_modulus_pa",
        "liver/2/poisson_ratio", "liver/hook/friction", "liver/stiffening", "liver/friction"})
  {
    EXPECT_THROW(SceneParameter(scene(), name), Error) << name;
  }
  SceneConfig open = scene();
  open.contacts[0].stiffness_pa_per_m.reset();
  EXPECT_THROW(SceneParameter(open, "liver/probe/stiffness_pa_per_m"), Error);
  open.tissues[0].material.young_modulus_pa = 0.0;
  EXPECT_THROW(SceneParameter(open, "liver/young_modulus_pa"), Error);
}

}  // namespace
}  // namespace soft_tissue
