#pragma once

#include "schema_section.h"

/**
 * The sections of a scene file and of a materials file: every key with its type, range and meaning.
 * They are the only place that knows the keys; parsing and docs/scene.md both follow them.
 */
namespace soft_tissue
{
/** A named material with where its numbers come from. */
struct PresetConfig
{
  std::string name;
  MaterialConfig material;
  std::pair<double, double> young_modulus_range_pa;
  std::string young_modulus_source;
  std::string poisson_ratio_source;
  std::pair<double, double> density_range_kg_per_m3;
  std::string density_source;
  std::optional<std::string> stiffening_source;
  std::optional<std::string> viscosity_source;
};

/** A materials file. */
struct PresetsConfig
{
  std::vector<PresetConfig> presets;
};

/** What a tool's shape may be: a solid, or links of a URDF. */
struct ToolShapeConfig
{
  ShapeConfig solid;
  std::optional<UrdfShapeConfig> urdf;
};

const Section<SceneConfig>& sceneSection();
const Section<TissueConfig>& tissueSection();
const Section<MembraneConfig>& membraneSection();
const Section<ToolConfig>& toolSection();
const Section<ToolShapeConfig>& toolShapeSection();
const Section<ObstacleConfig>& obstacleSection();
const Section<PoseSourceConfig>& poseSourceSection();
const Section<JointSourceConfig>& jointSourceSection();
const Section<JawConfig>& jawSection();
const Section<PoseKeyframe>& keyframeSection();
const Section<ContactConfig>& contactSection();
const Section<PoseConfig>& poseSection();
const Section<PresetsConfig>& presetsSection();

/** Rejects key frames under a key whose times do not ascend. */
template <class Keyframe>
void checkTimes(const Item& item, const char* key, const std::vector<Keyframe>& keyframes)
{
  for (std::size_t i = 1; i < keyframes.size(); ++i)
  {
    if (!(keyframes[i].time_s > keyframes[i - 1].time_s))
    {
      const Item before = item.at(key).at(i - 1).at("time_s");
      item.at(key).at(i).at("time_s").rejectValue("must be above " + before.path() + " = " +
                                                  before.written());
    }
  }
}

/** Joints by their names, with the values they have. */
Kind<std::vector<JointValue>> jointValues();

/** The ranges material constants must lie in, wherever they stand. */
constexpr Range kYoungModulus = {0.0, 1e12, Ends::open_below};
constexpr Range kPoissonRatio = {-1.0, 0.5, Ends::open};
constexpr Range kDensity = {0.0, 1e5, Ends::open_below};
constexpr Range kStiffening = {1e-3, 100.0, Ends::closed};
/** Of contacts and of what ties tissue to tools, Pa/m. */
constexpr Range kContactStiffness = {1.0, 1e15, Ends::closed};
Kind<MaterialModel> materialModel();
Kind<double> youngModulus();
Kind<double> poissonRatio();
Kind<double> density();
Kind<double> stiffening();
Kind<double> massDamping();
Kind<double> stiffnessDamping();
Kind<std::vector<RelaxationBranch>> relaxation();

/** Rejects a material, told at `item`, that its model does not take. */
void checkModel(const Item& item, MaterialModel model, double poisson_ratio,
                const std::optional<double>& stiffening);

/** A material as a tissue names it: a preset, explicit values, or a preset with some replaced. */
Kind<MaterialConfig> material();

/** Presets of the materials file `name`, which stands at or holds for `item`. */
std::vector<PresetConfig> loadPresets(const Item& item, const std::string& name);

/** Metres in one unit of a mesh file. */
Kind<double> lengthUnit();

/** Ranges that several sections share. */
Kind<Vec3> position();
Kind<Vec3> rotation();
Kind<double> shapeLength();

}  // namespace soft_tissue
