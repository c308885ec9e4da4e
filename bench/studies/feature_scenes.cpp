#include "feature_scenes.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"

namespace soft_tissue::studies
{
namespace
{
constexpr double kWidth = 0.06, kHeight = 0.03;      // of the block, m
constexpr double kProbe = 0.006;                     // radius of the probe, m
constexpr double kPressed = 0.004, kFarAway = -0.1;  // how deep it is, m
constexpr double kSeconds = 10.0;                    // for which the bottom is shaken

using Change = std::function<void(SceneConfig&)>;

/** Builds what all scenes have in common, and what is added to it. */
class Scenes
{
 public:
  Scenes(std::string folder, int cells) : folder_(std::move(folder)), cells_(cells)
  {
    block_ = saved("block", makeBox({2 * cells, 2 * cells, cells}, {kWidth, kWidth, kHeight}));
  }

  /** Nothing but the block. */
  SceneConfig plain() const
  {
    SceneConfig config;
    config.file = "features";
    config.time_step_s = 0.005;
    TissueConfig tissue;
    tissue.name = "block";
    tissue.mesh.file = block_;
    tissue.material = {MaterialModel::neo_hookean, 1e4, 0.4, 1000.0};
    tissue.keyframes.push_back(shaking());
    config.tissues.push_back(tissue);
    return config;
  }

  /** With a probe that goes so deep into its top in the first steps, m; below zero it stays away.
   */
  SceneConfig probed(double depth) const
  {
    SceneConfig config = plain();
    ToolConfig tool;
    tool.name = "probe";
    tool.shapes.push_back({SphereShape{kProbe}, {}});
    tool.initial_pose.position_m = {0.5 * kWidth, 0.5 * kWidth,
                                    kHeight + kProbe + std::max(0.001, -depth)};
    PoseConfig goal = tool.initial_pose;
    goal.position_m.z() = kHeight + kProbe - depth;
    tool.pose_source.kind = PoseSourceConfig::Kind::keyframes;
    tool.pose_source.keyframes = {{0.0, tool.initial_pose}, {0.02, goal}};
    config.tools.push_back(tool);
    config.contacts.push_back(pair("block", "probe"));
    return config;
  }

  /** Two halves, one above the other, of one mesh, the upper one held at its top, and pressed 2 mm
   * past touch or not. Parts nearer than half an edge at rest would not touch. */
  SceneConfig halves(bool pressed) const
  {
    const double gap = 0.6 * kHeight / cells_;
    const double half = 0.5 * kHeight;
    TetMesh mesh = makeBox({2 * cells_, 2 * cells_, cells_ / 2}, {kWidth, kWidth, half});
    const TetMesh lower = mesh;
    const auto count = static_cast<Index>(lower.nodes.size());
    for (const Vec3& p : lower.nodes)
    {
      mesh.nodes.emplace_back(p.x(), p.y(), p.z() + half + gap);
    }
    for (Tet tet : lower.tets)
    {
      for (Index& node : tet)
      {
        node += count;
      }
      mesh.tets.push_back(tet);
      mesh.tags.push_back(1);
    }
    SceneConfig config = plain();
    config.tissues[0].mesh.file = saved("halves", mesh);
    NodeMotionConfig top;
    top.nodes = {Vec3(-1.0, -1.0, kHeight + gap - 1e-6), Vec3(1.0, 1.0, 1.0)};
    top.motion.resize(2);
    top.motion[1].time_s = 0.04;
    top.motion[1].pose.position_m.z() = pressed ? -gap - 0.002 : 0.0;
    config.tissues[0].keyframes.push_back(top);
    return config;
  }

  /** A wall of cells of 3 mm at the block's side. */
  std::string wall() const
  {
    constexpr float kCell = 0.003f;
    octomap::OcTree tree(kCell);
    const int face = static_cast<int>(kWidth / kCell + 0.5);
    for (int y = -10; y < 30; ++y)
    {
      for (int z = -5; z < 20; ++z)
      {
        for (int x = face; x < face + 2; ++x)
        {
          tree.updateNode(
              octomap::point3d((x + 0.5f) * kCell, (y + 0.5f) * kCell, (z + 0.5f) * kCell), true);
        }
      }
    }
    const std::string file = folder_ + "/wall.bt";
    if (!tree.writeBinary(file))
    {
      throw Error(file + ": can't be written");
    }
    return file;
  }

  std::string saved(const std::string& name, const TetMesh& mesh) const
  {
    const std::string file = folder_ + "/" + name + ".msh";
    saveGmsh(file, mesh);
    return file;
  }

  int cells() const { return cells_; }
  const std::string& folder() const { return folder_; }

  static ContactConfig pair(const char* one, const char* other)
  {
    ContactConfig contact;
    contact.tissue = one;
    contact.other = other;
    return contact;
  }

 private:
  /** The bottom goes to and fro by 1 mm, four times a second. */
  static NodeMotionConfig shaking()
  {
    NodeMotionConfig bottom;
    bottom.nodes = {Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1e-9)};
    for (int k = 0; k <= static_cast<int>(8.0 * kSeconds); ++k)
    {
      PoseKeyframe frame;
      frame.time_s = 0.125 * k;
      frame.pose.position_m.x() = k % 2 == 0 ? 0.0 : 0.001;
      bottom.motion.push_back(frame);
    }
    return bottom;
  }

  std::string folder_, block_;
  int cells_;
};

SceneConfig with(SceneConfig config, const Change& change)
{
  change(config);
  return config;
}

/** Features of a pair: the pair without them, far apart with and without them, and in touch. */
void addOfPairs(const Scenes& scenes, std::vector<Feature>& all)
{
  const std::vector<std::pair<std::string, Change>> changes = {
      {"friction", [](SceneConfig& c) { c.contacts[0].friction = 0.3; }},
      {"contact damping", [](SceneConfig& c) { c.contacts[0].damping_s_per_m = 1.0; }},
      {"max_penetration", [](SceneConfig& c) { c.contacts[0].max_penetration_m = 1e-4; }}};
  for (const auto& [name, change] : changes)
  {
    all.push_back(
        {name + ", apart",
         {{"off", scenes.probed(kFarAway)}, {"idle", with(scenes.probed(kFarAway), change)}}});
    all.push_back(
        {name + ", in touch",
         {{"off", scenes.probed(kPressed)}, {"in use", with(scenes.probed(kPressed), change)}}});
  }
  all.push_back({"max_penetration, not reached",
                 {{"off", scenes.probed(kPressed)},
                  {"idle", with(scenes.probed(kPressed),
                                [](SceneConfig& c) { c.contacts[0].max_penetration_m = 0.02; })}}});
}

void addContacts(const Scenes& scenes, std::vector<Feature>& all)
{
  all.push_back({"contact with a tool",
                 {{"off", scenes.plain()},
                  {"idle", scenes.probed(kFarAway)},
                  {"in use", scenes.probed(kPressed)}}});
  const Change touch_itself = [](SceneConfig& c) {
    c.contacts.push_back(Scenes::pair("block", "block"));
  };
  all.push_back(
      {"self-contact, apart",
       {{"off", scenes.halves(false)}, {"idle", with(scenes.halves(false), touch_itself)}}});
  all.push_back(
      {"self-contact, in touch",
       {{"off", scenes.halves(true)}, {"in use", with(scenes.halves(true), touch_itself)}}});
  const std::string wall = scenes.wall();
  const auto obstacle = [&](double gap) {
    return [&wall, gap](SceneConfig& c) {
      ObstacleConfig cells;
      cells.name = "wall";
      cells.octomap.file = wall;
      cells.pose.position_m.x() = gap;
      c.obstacles.push_back(cells);
      c.contacts.push_back(Scenes::pair("block", "wall"));
    };
  };
  // Shaking pushes the block against it.
  all.push_back({"octomap obstacle",
                 {{"off", scenes.plain()},
                  {"idle", with(scenes.plain(), obstacle(0.3))},
                  {"in use", with(scenes.plain(), obstacle(1e-4))}}});
  all.push_back({"membrane",
                 {{"off", scenes.plain()},
                  {"in use", with(scenes.plain(), [&](SceneConfig& c) {
                     TriMesh sheet = makeSheet({2 * scenes.cells(), 2 * scenes.cells()},
                                               {kWidth, kWidth}, SheetPattern::alternating);
                     MembraneConfig membrane;
                     membrane.name = "sheet";
                     membrane.mesh.file = scenes.folder() + "/sheet.stl";
                     saveStl(membrane.mesh.file, sheet);
                     membrane.pose.position_m.z() = 3.0 * kHeight;
                     membrane.material = c.tissues[0].material;
                     membrane.thickness_m = 0.001;
                     membrane.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1e-9, 1.0, 1.0)});
                     c.membranes.push_back(membrane);
                   })}}});
}

void addOfMaterials(const Scenes& scenes, std::vector<Feature>& all)
{
  const std::vector<std::pair<std::string, Change>> changes = {
      {"mass damping", [](SceneConfig& c) { c.tissues[0].material.mass_damping_per_s = 1.0; }},
      {"stiffness damping",
       [](SceneConfig& c) { c.tissues[0].material.stiffness_damping_s = 0.01; }},
      {"relaxation, one term",
       [](SceneConfig& c) {
         c.tissues[0].material.relaxation = {{0.5, 0.1}};
       }},
      {"relaxation, three terms",
       [](SceneConfig& c) {
         c.tissues[0].material.relaxation = {{0.5, 0.1}, {0.3, 1.0}, {0.2, 10.0}};
       }},
      {"mass_spring in place of neo_hookean",
       [](SceneConfig& c) { c.tissues[0].material.model = MaterialModel::mass_spring; }},
      {"corotated in place of neo_hookean",
       [](SceneConfig& c) { c.tissues[0].material.model = MaterialModel::corotated; }},
      {"bdf2", [](SceneConfig& c) { c.solver.stepper = Stepper::bdf2; }},
      {"linear: cholesky", [](SceneConfig& c) { c.solver.linear = LinearSolverKind::cholesky; }}};
  for (const auto& [name, change] : changes)
  {
    all.push_back({name, {{"off", scenes.plain()}, {"in use", with(scenes.plain(), change)}}});
  }
  // As many nodes: a quadratic tet is cut into eight.
  const int half = scenes.cells() / 2;
  const std::string coarse =
      scenes.saved("coarse", makeBox({2 * half, 2 * half, half}, {kWidth, kWidth, kHeight}));
  all.push_back({"tet10 on as many nodes",
                 {{"off", scenes.plain()}, {"in use", with(scenes.plain(), [&](SceneConfig& c) {
                                              c.tissues[0].mesh.file = coarse;
                                              c.tissues[0].element = ElementKind::tet10;
                                            })}}});
}

void addOfSteps(const Scenes& scenes, std::vector<Feature>& all)
{
  const Change sleepy = [](SceneConfig& c) {
    c.solver.sleep = SleepConfig();
    c.solver.sleep->after_s = 0.01;
  };
  const Change still = [](SceneConfig& c) {
    c.gravity_m_per_s2.setZero();
    c.tissues[0].keyframes[0].motion.resize(1);
  };
  all.push_back(
      {"sleep, shaken", {{"off", scenes.plain()}, {"idle", with(scenes.plain(), sleepy)}}});
  all.push_back({"sleep, at rest",
                 {{"off", with(scenes.plain(), still)},
                  {"in use", with(with(scenes.plain(), still), sleepy)}}});
  const auto budget = [](double ms) { return [ms](SceneConfig& c) { c.solver.budget_ms = ms; }; };
  all.push_back({"budget",
                 {{"off", scenes.probed(kPressed)},
                  {"idle", with(scenes.probed(kPressed), budget(1e4))},
                  {"in use", with(scenes.probed(kPressed), budget(1e-3))}}});
  const Change stress = [](SceneConfig& c) { c.outputs.stress = true; };
  all.push_back({"stress output",
                 {{"off", scenes.plain(), 1, true},
                  {"idle", with(scenes.plain(), stress), 1, false},
                  {"in use", with(scenes.plain(), stress), 1, true}}});
  const auto field = [](const char* method, DepthKind depth, FieldRefresh refresh) {
    return [=](SceneConfig& c) {
      c.tissues[0].field.method = method;
      c.tissues[0].field.depth = depth;
      c.tissues[0].field.refresh = refresh;
    };
  };
  const Change full = field("exact_marching", DepthKind::closest_feature, FieldRefresh::full);
  all.push_back({"distance field, no contact",
                 {{"off", scenes.plain()}, {"idle", with(scenes.plain(), full)}}});
  const Change lazy = field("exact_marching", DepthKind::interpolated, FieldRefresh::lazy);
  all.push_back(
      {"field interpolated, lazy",
       {{"off", scenes.probed(kPressed)}, {"in use", with(scenes.probed(kPressed), lazy)}}});
  all.push_back(
      {"field everywhere in each step",
       {{"off", scenes.probed(kPressed)}, {"in use", with(scenes.probed(kPressed), full)}}});
  all.push_back({"a second thread",
                 {{"off", scenes.probed(kPressed)}, {"in use", scenes.probed(kPressed), 2}}});
}
}  // namespace

std::vector<Feature> featureScenes(const std::string& folder, int cells)
{
  const Scenes scenes(folder, cells);
  std::vector<Feature> all;
  addContacts(scenes, all);
  addOfPairs(scenes, all);
  addOfMaterials(scenes, all);
  addOfSteps(scenes, all);
  return all;
}
}  // namespace soft_tissue::studies
