#include <algorithm>

#include "schema_sections.h"

namespace soft_tissue
{
namespace
{
/** A material as written: what is left out comes from the preset. */
struct MaterialKeys
{
  std::optional<MaterialModel> model;
  std::optional<std::string> preset;
  std::optional<double> young_modulus_pa;
  std::optional<double> poisson_ratio;
  std::optional<double> density_kg_per_m3;
  std::optional<double> stiffening;
  std::optional<double> mass_damping_per_s;
  std::optional<double> stiffness_damping_s;
  std::optional<std::vector<RelaxationBranch>> relaxation;
};

const Section<RelaxationBranch>& relaxationSection()
{
  static const Section<RelaxationBranch> section =
      Section<RelaxationBranch>("relaxation",
                                "A stress that follows each change of the elastic one and then "
                                "goes away: a term of a Prony series.")
          .required("relative_modulus", &RelaxationBranch::relative_modulus,
                    number(0.0, 1000.0, Ends::open_below),
                    "Its stiffness, in that of the elastic stress, which stays. A published term g "
                    "of the stiffness at first is g / (1 - the sum of all).")
          .required("relaxation_time_s", &RelaxationBranch::relaxation_time,
                    number(0.0, 1e6, Ends::open_below), "After which 1/e of it is left.");
  return section;
}

template <class V>
Kind<std::optional<V>> orPreset(const Kind<V>& kind)
{
  return maybe(kind, "the preset's", false);
}

const Section<MaterialKeys>& materialSection()
{
  static const Section<MaterialKeys> section =
      Section<MaterialKeys>("material",
                            "A preset, or `young_modulus_pa`, `poisson_ratio` and "
                            "`density_kg_per_m3` in its place. Values that stand beside a preset "
                            "replace the preset's.")
          .optional(
              "model", &MaterialKeys::model,
              maybe(materialModel(),
                    "the preset's, else " + materialModel().show(MaterialConfig{}.model), false),
              "Strain energy, or springs; docs/methods.md has the formulas.")
          .optional("preset", &MaterialKeys::preset, maybe(text(), "none", false),
                    "Name of an entry of the materials file.")
          .optional("young_modulus_pa", &MaterialKeys::young_modulus_pa, orPreset(youngModulus()),
                    "Young's modulus at small strain.")
          .optional("poisson_ratio", &MaterialKeys::poisson_ratio, orPreset(poissonRatio()),
                    "Poisson's ratio at small strain.")
          .optional("density_kg_per_m3", &MaterialKeys::density_kg_per_m3, orPreset(density()),
                    "Density at rest.")
          .optional("stiffening", &MaterialKeys::stiffening, orPreset(stiffening()),
                    "How fast the exponential model stiffens: its shear stiffness grows by a "
                    "factor e where I_C - 3 of a stretch that keeps volume is one over this.")
          .optional("mass_damping_per_s", &MaterialKeys::mass_damping_per_s,
                    maybe(massDamping(), "the preset's, else 0", false),
                    "Force against a velocity, per mass and velocity: it slows rigid motion too. "
                    "Not for quasi_static.")
          .optional("stiffness_damping_s", &MaterialKeys::stiffness_damping_s,
                    maybe(stiffnessDamping(), "the preset's, else 0", false),
                    "Stress against a rate of strain, in the stiffness at small strain; rigid "
                    "motion goes on. Not for membranes, nor for model mass_spring.")
          .optional("relaxation", &MaterialKeys::relaxation,
                    maybe(relaxation(), "the preset's, else []", false),
                    "What of its stress is lost with time; Young's modulus is what stays. Not for "
                    "membranes, nor for model mass_spring.");
  return section;
}

MaterialConfig findPreset(const Item& item)
{
  const Item scene(item.document());
  const std::string file =
      scene.has("materials") ? scene.at("materials").scalar() : SceneConfig{}.materials;
  std::vector<std::string> known;
  for (const PresetConfig& preset : loadPresets(item, file))
  {
    if (preset.name == item.scalar())
    {
      return preset.material;
    }
    known.push_back(preset.name);
  }
  item.rejectValue("must be one of " + joined(known) + " (presets of " + file + ")");
}

MaterialConfig complete(const Item& item, const MaterialKeys& keys)
{
  MaterialConfig material;
  if (keys.preset)
  {
    material = findPreset(item.at("preset"));
  }
  for (const char* key : {"young_modulus_pa", "poisson_ratio", "density_kg_per_m3"})
  {
    if (!keys.preset && !item.has(key))
    {
      item.rejectKey(key, "missing, must be given where there is no preset");
    }
  }
  material.model = keys.model.value_or(material.model);
  material.young_modulus_pa = keys.young_modulus_pa.value_or(material.young_modulus_pa);
  material.poisson_ratio = keys.poisson_ratio.value_or(material.poisson_ratio);
  material.density_kg_per_m3 = keys.density_kg_per_m3.value_or(material.density_kg_per_m3);
  if (keys.stiffening && material.model != MaterialModel::exponential)
  {
    item.at("stiffening").rejectValue("is for model exponential, which is not asked for");
  }
  material.mass_damping_per_s = keys.mass_damping_per_s.value_or(material.mass_damping_per_s);
  material.stiffness_damping_s = keys.stiffness_damping_s.value_or(material.stiffness_damping_s);
  material.relaxation = keys.relaxation.value_or(material.relaxation);
  material.stiffening = keys.stiffening ? keys.stiffening : material.stiffening;
  checkModel(item, material.model, material.poisson_ratio, material.stiffening);
  return material;
}

}  // namespace

Kind<MaterialModel> materialModel()
{
  return choice<MaterialModel>({{"neo_hookean", MaterialModel::neo_hookean},
                                {"neo_hookean_log", MaterialModel::neo_hookean_log},
                                {"exponential", MaterialModel::exponential},
                                {"corotated", MaterialModel::corotated},
                                {"st_venant_kirchhoff", MaterialModel::st_venant_kirchhoff},
                                {"linear", MaterialModel::linear},
                                {"mass_spring", MaterialModel::mass_spring}});
}

void checkModel(const Item& item, MaterialModel model, double poisson_ratio,
                const std::optional<double>& stiffening)
{
  const double least = leastPoissonRatio(model);
  if (poisson_ratio < least)
  {
    item.reject("has poisson_ratio " + shortest(poisson_ratio) + ", must be at least " +
                shortest(least) + " with model " + materialModel().show(model));
  }
  if (model == MaterialModel::exponential && !stiffening)
  {
    item.rejectKey("stiffening", "missing, must be given with model exponential");
  }
}

Kind<double> youngModulus()
{
  return number(kYoungModulus);
}

Kind<double> poissonRatio()
{
  return number(kPoissonRatio);
}

Kind<double> density()
{
  return number(kDensity);
}

Kind<double> stiffening()
{
  return number(kStiffening);
}

Kind<double> massDamping()
{
  return number(0.0, 1e4, Ends::closed);
}

Kind<double> stiffnessDamping()
{
  return number(0.0, 1e3, Ends::closed);
}

Kind<std::vector<RelaxationBranch>> relaxation()
{
  return listOf(mapOf(relaxationSection()));
}

Kind<MaterialConfig> material()
{
  return madeFrom(mapOf(materialSection()), complete);
}

}  // namespace soft_tissue
