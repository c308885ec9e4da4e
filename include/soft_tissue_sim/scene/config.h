#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/contact/contact_law.h"
#include "soft_tissue_sim/energy/material.h"
#include "soft_tissue_sim/scene/pose_config.h"
#include "soft_tissue_sim/scene/tool_config.h"
#include "soft_tissue_sim/solver/linear_solver.h"

/**
 * A scene as its file names it, checked and in SI units, before anything is built from it.
 * The schema that fills these structs is in src/scene/schema_*.cpp; defaults stand here only.
 */
namespace soft_tissue
{
struct MaterialConfig
{
  MaterialModel model = MaterialModel::neo_hookean;
  double young_modulus_pa = 0.0;
  double poisson_ratio = 0.0;
  double density_kg_per_m3 = 0.0;
  std::optional<double> stiffening = {};  ///< of the exponential model, which needs it
  double mass_damping_per_s = 0.0;
  double stiffness_damping_s = 0.0;
  std::vector<RelaxationBranch> relaxation = {};
};

/** What a region with this tag has different from the tissue's material. */
struct RegionConfig
{
  int tag = 0;
  std::optional<MaterialModel> model;
  std::optional<double> young_modulus_pa;
  std::optional<double> poisson_ratio;
  std::optional<double> density_kg_per_m3;
  std::optional<double> stiffening;
};

/** Axis-aligned box in the world frame, metres. */
struct BoxConfig
{
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
};

/** Nodes that are moved like a rigid body, as frames go from the first one on. */
struct NodeMotionConfig
{
  BoxConfig nodes;                   ///< at rest
  std::vector<PoseKeyframe> motion;  ///< ascending times; linear / slerp between, held outside
};

enum class DepthKind
{
  interpolated,     ///< linear in the tet from nodal depths, as in both papers
  closest_feature,  ///< true distance to the nearest boundary feature
};

enum class FieldRefresh
{
  carried,  ///< nodal depths of the rest state, carried along
  lazy,     ///< marched anew on the deformed mesh each step, only as far as contacts read
  full,     ///< marched anew on the deformed mesh each step, everywhere
};

struct FieldConfig
{
  std::string method = "exact_marching";
  std::optional<int> grid_points;  ///< method grid alone
  DepthKind depth = DepthKind::closest_feature;
  FieldRefresh refresh = FieldRefresh::lazy;
};

enum class ElementKind
{
  tet4,       ///< linear tets
  tet4_anp,   ///< linear tets whose pressure is the mean of their nodes'
  tet10,      ///< quadratic tets, with a node in the middle of each edge of the mesh
  automatic,  ///< tet10 for coarse meshes, else tet4_anp or tet4: see elementFor()
};

/** What tissues and membranes have in common. */
struct SoftBodyConfig
{
  std::string name;
  MeshConfig mesh;
  PoseConfig pose;
  Vec3 velocity_m_per_s = Vec3::Zero();  ///< it starts with, world
  MaterialConfig material;
  std::vector<BoxConfig> fixed;
  std::vector<NodeMotionConfig> keyframes;
};

/** A soft body of tets. */
struct TissueConfig : SoftBodyConfig
{
  ElementKind element = ElementKind::tet4;
  std::vector<RegionConfig> regions;
  FieldConfig field;
};

/** A thin soft body of triangles; of its material the model does not count. */
struct MembraneConfig : SoftBodyConfig
{
  double thickness_m = 0.0;
};

/** Cells of an OctoMap. */
struct OctomapConfig
{
  std::string file;               ///< absolute path; empty where there is a topic
  std::string topic;              ///< of maps that replace each other
  double resolution_m = 0.0;      ///< edge length of their finest cells; of a topic alone
  int depth = 16;                 ///< of the octree: 16 are the map's finest cells
  bool unknown_occupied = false;  ///< what the map says nothing of, in it and around it
};

struct ObstacleConfig
{
  std::string name;
  PoseConfig pose;  ///< of the map's frame in the world
  OctomapConfig octomap;
};

enum class Response
{
  point,
  segment,
  automatic,  ///< points where edges are shorter than kFineEdge, else segments
};

/** Below this a surface's edges are fine enough for contact at its nodes, in the radius of the
 * largest ball inside the smaller of the bodies. */
constexpr double kFineEdge = 0.125;

/** Contact stiffness that a scene leaves to us, in the tissue's Young's modulus over the tool's
 * inner radius, half a cell of an obstacle; of two tissues the softer one's modulus and the smaller
 * inner radius, of a tissue and a membrane the tissue's; of a membrane and a tool or obstacle its
 * modulus times thickness over the square of that radius. */
constexpr double kAutoStiffness = 20.0;

struct ContactConfig
{
  std::string tissue;  ///< or membrane
  std::string other;   ///< tool, obstacle, another tissue, or the same, which then touches itself
  Response response = Response::segment;
  ContactLaw law = ContactLaw::pressure;
  std::optional<double> stiffness_pa_per_m;  ///< empty: kAutoStiffness
  std::optional<double> penalty;             ///< the constant of a law that isn't pressure
  double friction = 0.0;                     ///< Coulomb coefficient
  double damping_s_per_m = 0.0;
  std::optional<double> max_penetration_m;  ///< empty: as deep as the stiffness lets it
};

enum class Stepper
{
  implicit_euler,
  bdf2,
  quasi_static,
};

/** When tissues are at rest: then they are left out until something comes near. */
struct SleepConfig
{
  double speed_m_per_s = 1e-3;         ///< no node is faster
  double acceleration_m_per_s2 = 0.1;  ///< nor gets faster more quickly
  double after_s = 0.5;                ///< for so long
};

struct SolverConfig
{
  Stepper stepper = Stepper::implicit_euler;
  double tolerance = 1.0e-3;  ///< residual over the sum of the norms of the acting forces
  int max_iterations = 20;    ///< Newton iterations a step may take
  LinearSolverKind linear = LinearSolverKind::automatic;
  /** Wall time a step may take; empty: as long as it needs. With one, steps depend on the machine
   * and its load. */
  std::optional<double> budget_ms;
  std::optional<SleepConfig> sleep;  ///< empty: never
};

/** The tissues as cells of an OctoMap. */
struct OctomapOutputConfig
{
  double resolution_m = 0.0;  ///< edge length of the cells
  double rate_hz = 2.0;       ///< most maps a second; 0: one for every step that is published
};

struct OutputsConfig
{
  bool stress = false;
  std::optional<OctomapOutputConfig> octomap;  ///< empty: none
};

struct SceneConfig
{
  std::string file;  ///< where it came from, for messages
  /** Where material presets are looked up: the name in the package, or the path a scene names. */
  std::string materials = "package://soft_tissue_sim/config/materials.yaml";
  double time_step_s = 0.005;
  Vec3 gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  SolverConfig solver;
  std::vector<TissueConfig> tissues;
  std::vector<MembraneConfig> membranes;
  std::vector<ToolConfig> tools;
  std::vector<ObstacleConfig> obstacles;
  std::vector<ContactConfig> contacts;
  OutputsConfig outputs;

  /** Tissues, and after them membranes, as Scene numbers them. */
  const SoftBodyConfig& softBody(std::size_t index) const
  {
    return index < tissues.size() ? static_cast<const SoftBodyConfig&>(tissues[index])
                                  : membranes[index - tissues.size()];
  }
};

/** Folder of a package, or empty when there is none; the node layer gives one that asks rospack. */
using PackageResolver = std::string (*)(const std::string& package);

/**
 * Reads and checks a scene file.
 * @param path      YAML file; relative names in it are taken from its folder
 * @param resolver  finds packages for package:// names; may be null, then such names are errors
 * @throws Error naming file, key, value and allowed range
 */
SceneConfig loadSceneConfig(const std::string& path, PackageResolver resolver);

/** Markdown of all keys a scene file and a materials file may have: the text of docs/scene.md. */
std::string describeSchema();

}  // namespace soft_tissue
