#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
void checkInside(const Item& item, double value, const std::pair<double, double>& range,
                 const Item& range_item)
{
  if (value < range.first || value > range.second)
  {
    item.rejectValue("must be in " + range_item.path() + " = " + range_item.written());
  }
}

const Section<PresetConfig>& presetSection()
{
  static const Section<PresetConfig> section =
      Section<PresetConfig>("preset", "One material with where its numbers come from.")
          .required("name", &PresetConfig::name, name(), "What scene files call it.")
          .required(
              "model", [](PresetConfig & p) -> auto& { return p.material.model; }, materialModel(),
              "Strain energy.")
          .required(
              "young_modulus_pa",
              [](PresetConfig & p) -> auto& { return p.material.young_modulus_pa; }, youngModulus(),
              "Young's modulus at small strain; inside the range below.")
          .required("young_modulus_range_pa", &PresetConfig::young_modulus_range_pa,
                    numberRange(1e12), "Least and greatest published value.")
          .required("young_modulus_source", &PresetConfig::young_modulus_source, text(),
                    "Authors, year and what was measured.")
          .required(
              "poisson_ratio", [](PresetConfig & p) -> auto& { return p.material.poisson_ratio; },
              poissonRatio(), "Poisson's ratio at small strain.")
          .required("poisson_ratio_source", &PresetConfig::poisson_ratio_source, text(),
                    "Authors and year, or why it was chosen.")
          .required(
              "density_kg_per_m3",
              [](PresetConfig & p) -> auto& { return p.material.density_kg_per_m3; }, density(),
              "Density; inside the range below.")
          .required("density_range_kg_per_m3", &PresetConfig::density_range_kg_per_m3,
                    numberRange(1e5), "Least and greatest published value.")
          .required("density_source", &PresetConfig::density_source, text(),
                    "Authors, year and what was measured.")
          .optional(
              "stiffening", [](PresetConfig & p) -> auto& { return p.material.stiffening; },
              maybe(stiffening(), "none", false), "Of model exponential, which needs it.")
          .optional("stiffening_source", &PresetConfig::stiffening_source,
                    maybe(text(), "none", false), "Authors, year and what it was fitted to.")
          .optional(
              "mass_damping_per_s",
              [](PresetConfig & p) -> auto& { return p.material.mass_damping_per_s; },
              massDamping(), "As in a scene.")
          .optional(
              "stiffness_damping_s",
              [](PresetConfig & p) -> auto& { return p.material.stiffness_damping_s; },
              stiffnessDamping(), "As in a scene.")
          .optional(
              "relaxation", [](PresetConfig & p) -> auto& { return p.material.relaxation; },
              relaxation(), "As in a scene.")
          .optional("viscosity_source", &PresetConfig::viscosity_source,
                    maybe(text(), "none", false),
                    "Where damping or relaxation come from: authors, year and what was measured.")
          .finally([](const Item& item, PresetConfig& preset) {
            checkModel(item, preset.material.model, preset.material.poisson_ratio,
                       preset.material.stiffening);
            for (const char* key : {"mass_damping_per_s", "stiffness_damping_s", "relaxation"})
            {
              if (item.has(key) && !item.has("viscosity_source"))
              {
                item.rejectKey("viscosity_source",
                               std::string("missing, must be given with ") + key);
              }
            }
            if (item.has("stiffening") && !item.has("stiffening_source"))
            {
              item.rejectKey("stiffening_source", "missing, must be given with stiffening");
            }
            checkInside(item.at("young_modulus_pa"), preset.material.young_modulus_pa,
                        preset.young_modulus_range_pa, item.at("young_modulus_range_pa"));
            checkInside(item.at("density_kg_per_m3"), preset.material.density_kg_per_m3,
                        preset.density_range_kg_per_m3, item.at("density_range_kg_per_m3"));
          });
  return section;
}

void checkNames(const Item& item, PresetsConfig& config)
{
  for (std::size_t i = 0; i < config.presets.size(); ++i)
  {
    for (std::size_t j = 0; j < i; ++j)
    {
      if (config.presets[i].name == config.presets[j].name)
      {
        item.at("presets").at(i).at("name").rejectValue("is the name of presets[" +
                                                        std::to_string(j) + "], must be new");
      }
    }
  }
}

}  // namespace

const Section<PresetsConfig>& presetsSection()
{
  static const Section<PresetsConfig> section =
      Section<PresetsConfig>("materials file",
                             "What `materials` of a scene names: the presets that "
                             "`material: {preset: NAME}` may use.")
          .required("presets", &PresetsConfig::presets, listOf(mapOf(presetSection()), 1),
                    "The materials.")
          .finally(checkNames);
  return section;
}

std::vector<PresetConfig> loadPresets(const Item& item, const std::string& name)
{
  const Document document = readDocument(resolveFile(item, name), item.document().resolver);
  return presetsSection().read(Item(document)).presets;
}

}  // namespace soft_tissue
