#include <algorithm>

#include "element_choice.h"
#include "schema_sections.h"
#include "soft_tissue_sim/field/distance_field.h"

namespace soft_tissue
{
namespace
{
const Section<MeshConfig>& meshSection()
{
  static const Section<MeshConfig> section =
      Section<MeshConfig>("mesh", "A tetrahedral mesh file, or one of triangles for a membrane.")
          .required("file", &MeshConfig::file, file(),
                    "Gmsh, VTK, TetGen, Medit or PLY; of triangles STL, OBJ, PLY or VTK. Relative "
                    "paths start at the scene file.")
          .required("length_unit", &MeshConfig::metres_per_unit, lengthUnit(),
                    "Unit of the coordinates in the file.");
  return section;
}

const Section<RegionConfig>& regionSection()
{
  static const Section<RegionConfig> section =
      Section<RegionConfig>("region",
                            "Tets with a tag of the mesh file, and what is different in them.")
          .required("tag", &RegionConfig::tag, integer(0, 2147483647),
                    "Physical group or region number in the mesh file.")
          .optional("model", &RegionConfig::model, maybe(materialModel(), "the material's", false),
                    "Strain energy there.")
          .optional("young_modulus_pa", &RegionConfig::young_modulus_pa,
                    maybe(youngModulus(), "the material's", false), "Young's modulus there.")
          .optional("poisson_ratio", &RegionConfig::poisson_ratio,
                    maybe(poissonRatio(), "the material's", false), "Poisson's ratio there.")
          .optional("density_kg_per_m3", &RegionConfig::density_kg_per_m3,
                    maybe(density(), "the material's", false), "Density there.")
          .optional("stiffening", &RegionConfig::stiffening,
                    maybe(stiffening(), "the material's", false), "Of model exponential there.")
          .finally([](const Item& item, RegionConfig&) {
            if (item.keys().size() == 1)
            {
              item.reject("changes nothing, must have more keys than tag");
            }
          });
  return section;
}

const Section<BoxConfig>& fixedSection()
{
  static const Section<BoxConfig> section =
      Section<BoxConfig>("fixed", "Nodes that stay where they are at rest.")
          .required(
              "box_m", [](BoxConfig& b) -> BoxConfig& { return b; }, box(),
              "All nodes in this box, borders included, along the world's axes.");
  return section;
}

const Section<FieldConfig>& fieldSection()
{
  static const Section<FieldConfig> section =
      Section<FieldConfig>("field", "The distance field inside a tissue, which contact reads.")
          .optional("method", &FieldConfig::method,
                    choice<std::string>({{"exact_marching", "exact_marching"},
                                         {"cffm", "cffm"},
                                         {"cpfm", "cpfm"},
                                         {"grid", "grid"}}),
                    "How nodal depths are computed. exact_marching: exactly; cffm, cpfm: marching "
                    "closest features or points, which may come out too large; grid: marching a "
                    "grid around the tissue.")
          .optional("grid_points", &FieldConfig::grid_points,
                    maybe(integer(FieldOptions::kLeastGridPoints, 400),
                          std::to_string(FieldOptions().grid_points), false),
                    "Points of the grid along the tissue's longest side; for method grid alone.")
          .optional("depth", &FieldConfig::depth,
                    choice<DepthKind>({{"interpolated", DepthKind::interpolated},
                                       {"closest_feature", DepthKind::closest_feature}}),
                    "Depth between the nodes: linear in the tet, or the true distance to the "
                    "nearest boundary feature.")
          .optional(
              "refresh", &FieldConfig::refresh,
              choice<FieldRefresh>({{"carried", FieldRefresh::carried},
                                    {"lazy", FieldRefresh::lazy},
                                    {"full", FieldRefresh::full}}),
              "carried: depths of the rest state; lazy: marched as far as contacts read, each "
              "step where depths are interpolated, else once; full: marched each step "
              "everywhere.")
          .finally([](const Item& item, FieldConfig& field) {
            if (field.grid_points && field.method != "grid")
            {
              item.at("grid_points").rejectValue("is for method grid, which is not asked for");
            }
          });
  return section;
}

const Section<NodeMotionConfig>& nodeMotionSection()
{
  static const Section<NodeMotionConfig> section =
      Section<NodeMotionConfig>("moved nodes",
                                "Nodes that move like a rigid body, with a frame that goes from "
                                "its first key frame on to the others.")
          .required("nodes", &NodeMotionConfig::nodes, mapOf(fixedSection()), "Which, at rest.")
          .required("motion", &NodeMotionConfig::motion, listOf(mapOf(keyframeSection()), 1),
                    "The frame at times: linear between them (slerp for the rotation), held "
                    "before the first and after the last.")
          .finally([](const Item& item, NodeMotionConfig& moved) {
            checkTimes(item, "motion", moved.motion);
          });
  return section;
}

void checkRegions(const Item& item, TissueConfig& tissue)
{
  const MaterialConfig& material = tissue.material;
  for (std::size_t i = 0; i < tissue.regions.size(); ++i)
  {
    const RegionConfig& region = tissue.regions[i];
    const Item place = item.at("regions").at(i);
    const MaterialModel model = region.model.value_or(material.model);
    if (region.stiffening && model != MaterialModel::exponential)
    {
      place.at("stiffening").rejectValue("is for model exponential, which is not asked for");
    }
    checkModel(place, model, region.poisson_ratio.value_or(material.poisson_ratio),
               region.stiffening ? region.stiffening : material.stiffening);
    for (std::size_t j = 0; j < i; ++j)
    {
      if (tissue.regions[i].tag == tissue.regions[j].tag)
      {
        place.at("tag").rejectValue("is the tag of regions[" + std::to_string(j) +
                                    "], must be new");
      }
    }
  }
}

bool hasSprings(const TissueConfig& tissue)
{
  return tissue.material.model == MaterialModel::mass_spring ||
         std::any_of(tissue.regions.begin(), tissue.regions.end(), [](const RegionConfig& region) {
           return region.model == MaterialModel::mass_spring;
         });
}

/** Springs join the vertices of a mesh, and have neither strain nor its rate. */
void checkSprings(const Item& item, const TissueConfig& tissue)
{
  if (!hasSprings(tissue))
  {
    return;
  }
  if (tissue.element != ElementKind::tet4)
  {
    item.at("element").rejectValue("must be tet4 with model mass_spring");
  }
  if (!tissue.material.relaxation.empty() || tissue.material.stiffness_damping_s > 0.0)
  {
    item.at("material")
        .reject("has relaxation or stiffness_damping_s, which model mass_spring doesn't take");
  }
}

/** Keys that tissues and membranes share, up to the material. */
template <typename Body>
Section<Body>& addPlace(Section<Body>& section, const std::string& mesh)
{
  return section
      .required("name", &Body::name, name(),
                "Its ROS namespace; unlike that of any other body or tool, and not tissue_pairs.")
      .required("mesh", &Body::mesh, mapOf(meshSection()), mesh)
      .optional("pose", &Body::pose, mapOf(poseSection()),
                "Where the mesh file's frame stands in the world at rest.")
      .optional("velocity_m_per_s", &Body::velocity_m_per_s, vectorOfNorm(1000.0),
                "What all of it but its fixed nodes moves with at first, in the world frame.")
      .required("material", &Body::material, material(), "What it is made of.");
}

/** And the rest. */
template <typename Body>
Section<Body>& addHolds(Section<Body>& section)
{
  return section.optional("fixed", &Body::fixed, listOf(mapOf(fixedSection())), "Where it is held.")
      .optional("keyframes", &Body::keyframes, listOf(mapOf(nodeMotionSection())),
                "Where it is held and moved.");
}
}  // namespace

const Section<TissueConfig>& tissueSection()
{
  static const Section<TissueConfig> section = [] {
    Section<TissueConfig> keys("tissue", "A soft body.");
    addPlace(keys, "Its rest shape.");
    keys.optional("element", &TissueConfig::element,
                  choice<ElementKind>({{"tet4", ElementKind::tet4},
                                       {"tet4_anp", ElementKind::tet4_anp},
                                       {"tet10", ElementKind::tet10},
                                       {"auto", ElementKind::automatic}}),
                  "tet4: linear; tet4_anp: linear with average nodal pressure, which does not "
                  "lock near a Poisson's ratio of 0.5; tet10: quadratic, with a node in the middle "
                  "of each edge of the mesh as well; auto: " +
                      describeElementChoice() + ".");
    keys.optional("regions", &TissueConfig::regions, listOf(mapOf(regionSection())),
                  "Parts of other material; each tag once.");
    addHolds(keys);
    keys.optional("field", &TissueConfig::field, mapOf(fieldSection()),
                  "Its distance field; marched only if the tissue has a contact.")
        .finally([](const Item& item, TissueConfig& tissue) {
          checkRegions(item, tissue);
          checkSprings(item, tissue);
        });
    return keys;
  }();
  return section;
}

const Section<MembraneConfig>& membraneSection()
{
  static const Section<MembraneConfig> section = [] {
    Section<MembraneConfig> keys(
        "membrane", "A thin soft body, stress-free as it is in its mesh file, flat or curved.");
    addPlace(keys, "Its rest shape: triangles half way through its thickness.");
    keys.required("thickness_m", &MembraneConfig::thickness_m, number(0.0, 0.1, Ends::open_below),
                  "What it weighs, stretches and bends by; contact is with the middle of it.");
    addHolds(keys);
    keys.finally([](const Item& item, MembraneConfig& membrane) {
      for (const char* key : {"model", "stiffening"})
      {
        if (item.at("material").has(key))
        {
          item.at("material")
              .at(key)
              .rejectValue("is for tissues, a membrane has a law of its own");
        }
      }
      if (!membrane.material.relaxation.empty() || membrane.material.stiffness_damping_s > 0.0)
      {
        item.at("material")
            .reject(
                "has relaxation or stiffness_damping_s, which are for tissues, not for membranes");
      }
    });
    return keys;
  }();
  return section;
}

}  // namespace soft_tissue
