#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <ostream>

#include "soft_tissue_sim/base/state_archive.h"
#include "support/state_scenes.h"
#include "support/voxel_scenes.h"

namespace soft_tissue::test
{
namespace
{
/** A scene with something of its own to remember, and how it is driven. */
struct Case
{
  const char* name;
  std::function<SceneConfig(const ScratchFolder&)> config;
  /** Called before each step, with its number from 0. */
  std::function<void(Scene&, int)> drive = [](Scene&, int) {};
};

void PrintTo(const Case& one, std::ostream* out)
{
  *out << one.name;
}

constexpr int kBefore = 14, kAfter = 14;

template <typename Change>
auto changed(const Change& change)
{
  return [change](const ScratchFolder& folder) {
    SceneConfig config = stroked(folder);
    change(config);
    return config;
  };
}

FieldConfig field(const std::string& method, DepthKind depth, FieldRefresh refresh)
{
  FieldConfig config;
  config.method = method;
  config.depth = depth;
  config.refresh = refresh;
  return config;
}

/** Two balls that start in each other and rub. */
SceneConfig balls(const ScratchFolder& folder)
{
  const std::string file = saved(folder, "ball.msh", makeBall(0.02, 500));
  SceneConfig config = tissueScene(file);
  addTissue(config, "other", file, Vec3(0.004, 0.0, 0.036)).velocity_m_per_s = Vec3(0.1, 0.0, 0.0);
  addPair(config, "tissue", "other", Response::segment).friction = 0.3;
  addPair(config, "tissue", "tissue", Response::point);
  return config;
}

/** A ball that falls on a map. */
SceneConfig landing(const ScratchFolder& folder)
{
  SceneConfig config = tissueScene(saved(folder, "ball.msh", makeBall(0.02, 500)));
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  config.tissues[0].velocity_m_per_s = Vec3(0.2, 0.0, -0.3);
  config.tissues[0].pose.position_m.z() = 0.022;
  addLiveMap(config, 0.005, Response::segment);
  config.contacts[0].friction = 0.4;
  return config;
}

void bringTheFloor(Scene& scene, int step)
{
  VoxelSet cells(0.005);
  cells.fill({Cell(-20, -20, -3), Cell(20, 20, 0)}, true);
  if (step == 10)
  {
    cells.fill({Cell(-3, -3, 0), Cell(2, 2, 4)}, true);  // takes some of the ball in
  }
  if (step == 0 || step == 10)
  {
    scene.setObstacleCells(0, std::move(cells));
  }
}

std::vector<Case> cases()
{
  const auto segment = DepthKind::closest_feature, linear = DepthKind::interpolated;
  return {
      {"friction", changed([](SceneConfig&) {})},
      {"points", changed([](SceneConfig& c) { c.contacts[0].response = Response::point; })},
      {"bdf2", changed([](SceneConfig& c) { c.solver.stepper = Stepper::bdf2; })},
      {"quasi_static", changed([](SceneConfig& c) { c.solver.stepper = Stepper::quasi_static; })},
      {"cholesky", changed([](SceneConfig& c) { c.solver.linear = LinearSolverKind::cholesky; })},
      {"coarse_tolerance", changed([](SceneConfig& c) { c.solver.tolerance = 0.02; })},
      {"fine_tolerance", changed([](SceneConfig& c) { c.solver.tolerance = 1e-7; })},
      {"stiffening", changed([](SceneConfig& c) {
         c.contacts[0].stiffness_pa_per_m = 1e5;
         c.contacts[0].max_penetration_m = 1e-4;
       })},
      {"contact_damping", changed([](SceneConfig& c) { c.contacts[0].damping_s_per_m = 2.0; })},
      {"viscous", changed([](SceneConfig& c) {
         c.tissues[0].material.relaxation = {{0.05, 0.5}, {0.5, 0.3}};
         c.tissues[0].material.stiffness_damping_s = 0.01;
         c.tissues[0].material.mass_damping_per_s = 3.0;
       })},
      {"tet10", changed([](SceneConfig& c) { c.tissues[0].element = ElementKind::tet10; })},
      {"grid_field", changed([=](SceneConfig& c) {
         c.tissues[0].field = field("grid", linear, FieldRefresh::full);
       })},
      {"lazy_linear", changed([=](SceneConfig& c) {
         c.tissues[0].field = field("cffm", linear, FieldRefresh::lazy);
       })},
      {"carried_cpfm", changed([=](SceneConfig& c) {
         c.tissues[0].field = field("cpfm", linear, FieldRefresh::carried);
       })},
      {"carried_exact", changed([=](SceneConfig& c) {
         c.tissues[0].field = field("exact_marching", segment, FieldRefresh::carried);
       })},
      {"driven_from_outside",
       [](const ScratchFolder& folder) {
         SceneConfig config = stroked(folder);
         config.tools[0].initial_pose = config.tools[0].pose_source.keyframes[0].pose;
         config.tools[0].pose_source = PoseSourceConfig();
         return config;
       },
       [](Scene& scene, int step) {
         if (step < kBefore)  // later steps go on to where the last command was for
         {
           const Vec3 at(0.0005 * step, 0.0, kBlockTop + 0.01 - 0.0002 * step);
           scene.setToolTarget(0, Pose(Eigen::Translation3d(at)));
         }
       }},
      {"moved_nodes", changed([](SceneConfig& c) {
         c.tissues[0].fixed.clear();
         c.tissues[0].keyframes = {{{Vec3(-1, -1, -1), Vec3(1, 1, 1e-6)},
                                    {{0.0, {}}, {0.3, {Vec3(0.005, 0.0, 0.004), Vec3::Zero()}}}}};
       })},
      {"membrane",
       [](const ScratchFolder& folder) {
         SceneConfig config = stroked(folder);
         MembraneConfig skin;
         static_cast<SoftBodyConfig&>(skin) = config.tissues[0];
         skin.name = "skin";
         skin.mesh.file = folder.path("skin.stl");
         saveStl(skin.mesh.file, makeSheet({6, 6}, {0.05, 0.05}, SheetPattern::irregular));
         skin.pose.position_m = Vec3(-0.025, -0.025, kBlockTop + 0.0004);
         skin.fixed.clear();
         skin.thickness_m = 0.0005;
         config.membranes.push_back(skin);
         addPair(config, "skin", "tool", Response::segment).friction = 0.2;
         addPair(config, "skin", "tissue", Response::segment);
         return config;
       }},
      {"two_tissues", balls},
      {"two_tissues_bdf2",
       [](const ScratchFolder& folder) {
         SceneConfig config = balls(folder);
         config.solver.stepper = Stepper::bdf2;
         return config;
       }},
      {"obstacle", landing, bringTheFloor},
      {"obstacle_points_bdf2",
       [](const ScratchFolder& folder) {
         SceneConfig config = landing(folder);
         config.solver.stepper = Stepper::bdf2;
         config.contacts[0].response = Response::point;
         return config;
       },
       bringTheFloor},
      {"sleep",
       [](const ScratchFolder& folder) {
         SceneConfig config = balls(folder);
         config.solver.sleep = SleepConfig{10.0, 1e3, 0.05};  // at once
         addTissue(config, "far", config.tissues[0].mesh.file, Vec3(1.0, 0.0, 0.0))
             .velocity_m_per_s = Vec3(20.0, 0.0, 0.0);
         return config;
       }},
  };
}

class State : public testing::TestWithParam<Case>
{
 protected:
  void run(Scene& scene, int from, int to, std::vector<std::uint64_t>* hashes = nullptr)
  {
    for (int k = from; k < to; ++k)
    {
      GetParam().drive(scene, k);
      scene.step();
      if (hashes != nullptr)
      {
        hashes->push_back(scene.stateHash());
      }
    }
  }

  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Scenes, State, testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(State, StepsAfterItWasLoadedHaveTheBitsOfThoseWithout)
{
  const SceneConfig config = GetParam().config(folder_);
  std::vector<std::uint64_t> expected, saved_too, loaded, again;
  Scene never(config);
  run(never, 0, kBefore + kAfter, &expected);
  Scene saving(config);
  run(saving, 0, kBefore);
  const std::string file = folder_.path("state");
  saving.saveState(file);
  Scene fresh(config);
  fresh.loadState(file);
  expectSame(saving, fresh);
  run(saving, kBefore, kBefore + kAfter, &saved_too);
  run(fresh, kBefore, kBefore + kAfter, &loaded);
  saving.loadState(file);
  run(saving, kBefore, kBefore + kAfter, &again);
  expected.erase(expected.begin(), expected.begin() + kBefore);
  EXPECT_EQ(saved_too, expected) << "saving changes nothing";
  EXPECT_EQ(loaded, expected) << "in another scene";
  EXPECT_EQ(again, expected) << "in one that had gone on";
  expectSame(never, fresh);
}

TEST_P(State, IsTheSameFileAfterItWasLoaded)
{
  const SceneConfig config = GetParam().config(folder_);
  Scene scene(config), other(config);
  run(scene, 0, kBefore);
  scene.saveState(folder_.path("state"));
  other.loadState(folder_.path("state"));
  other.saveState(folder_.path("again"));
  EXPECT_EQ(readBytes(folder_.path("state")), readBytes(folder_.path("again")));
}

}  // namespace
}  // namespace soft_tissue::test
