#include <gtest/gtest.h>

#include <cstdio>
#include <functional>
#include <ostream>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/hash.h"
#include "soft_tissue_sim/base/state_archive.h"
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

/** A block that a ball presses down and strokes, from step to step. */
SceneConfig stroked(const ScratchFolder& folder)
{
  SceneConfig config = blockScene(folder, {5, 5, 3});
  fixBelow(config, 1e-6);
  addTool(config, SphereShape{0.01}, {}, Response::segment);
  config.contacts[0].friction = 0.5;
  config.tools[0].pose_source.kind = PoseSourceConfig::Kind::keyframes;
  config.tools[0].pose_source.keyframes = {{0.0, {Vec3(0.0, 0.0, kBlockTop + 0.0101), {}}},
                                           {0.1, {Vec3(0.0, 0.0, kBlockTop + 0.007), {}}},
                                           {0.4, {Vec3(0.008, 0.003, kBlockTop + 0.006), {}}}};
  return config;
}

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
                                    {{0.0, {}}, {0.3, {Vec3(0.005, 0.0, 0.004), {}}}}}};
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

void expectSame(const std::vector<ContactPoint>& a, const std::vector<ContactPoint>& b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    EXPECT_EQ(a[i].position_W, b[i].position_W);
    EXPECT_EQ(a[i].force_W, b[i].force_W);
    EXPECT_EQ(a[i].depth, b[i].depth);
    EXPECT_EQ(a[i].tet, b[i].tet);
  }
}

void expectSame(const Scene& one, const Scene& other)
{
  Snapshot a, b;
  one.fillSnapshot(a);
  other.fillSnapshot(b);
  EXPECT_EQ(a.state_hash, b.state_hash);
  EXPECT_EQ(a.report.step, b.report.step);
  EXPECT_EQ(a.report.time_s, b.report.time_s);
  EXPECT_EQ(a.report.residual, b.report.residual);
  EXPECT_EQ(a.report.contacts, b.report.contacts);
  EXPECT_EQ(a.report.max_penetration_m, b.report.max_penetration_m);
  EXPECT_EQ(a.report.min_det_f, b.report.min_det_f);
  for (std::size_t k = 0; k < a.tissues.size(); ++k)
  {
    EXPECT_EQ(a.tissues[k].positions, b.tissues[k].positions);
    EXPECT_EQ(a.tissues[k].asleep, b.tissues[k].asleep);
  }
  for (std::size_t k = 0; k < a.tools.size(); ++k)
  {
    EXPECT_EQ(a.tools[k].X_WT.matrix(), b.tools[k].X_WT.matrix());
    EXPECT_EQ(a.tools[k].wrench_W.force, b.tools[k].wrench_W.force);
    expectSame(a.tools[k].contacts, b.tools[k].contacts);
  }
  for (std::size_t k = 0; k < a.obstacles.size(); ++k)
  {
    expectSame(a.obstacles[k].contacts, b.obstacles[k].contacts);
    EXPECT_EQ(one.obstacles()[k].surface.nodes, other.obstacles()[k].surface.nodes);
  }
  for (std::size_t k = 0; k < a.tissue_pairs.size(); ++k)
  {
    expectSame(a.tissue_pairs[k].contacts, b.tissue_pairs[k].contacts);
  }
}

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

TEST(StateFile, OfASceneThatHasNotBegun)
{
  const ScratchFolder folder;
  const SceneConfig config = stroked(folder);
  Scene scene(config), other(config);
  scene.saveState(folder.path("state"));
  for (int k = 0; k < 5; ++k)
  {
    other.step();
  }
  other.loadState(folder.path("state"));
  expectSame(scene, other);
  scene.step();
  other.step();
  expectSame(scene, other);
}

/** What loading a file complains of, its name as FILE; nothing may have changed by that. */
std::string complaint(Scene& scene, const std::string& file)
{
  const std::uint64_t before = scene.stateHash();
  std::string text = "none";
  try
  {
    scene.loadState(file);
  }
  catch (const Error& error)
  {
    text = error.what();
    EXPECT_EQ(scene.stateHash(), before);
    const std::size_t at = text.find(file);
    text = at == std::string::npos ? text : text.replace(at, file.size(), "FILE");
  }
  return text;
}

TEST(StateFile, OfAnotherSceneOrDamagedIsRefusedAndNothingChanges)
{
  const ScratchFolder folder;
  const SceneConfig config = stroked(folder);
  Scene scene(config), untouched(config);
  const std::string file = folder.path("state");
  for (int k = 0; k < 5; ++k)
  {
    scene.step();
    untouched.step();
  }
  scene.saveState(file);
  const std::string good = readBytes(file);
  EXPECT_EQ(complaint(scene, folder.path("gone")), "FILE: can't be read");
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{9}, good.size() / 2, good.size() - 1})
  {
    writeBytes(folder.path("cut"), good.substr(0, length));
    const std::string said = complaint(scene, folder.path("cut"));
    EXPECT_TRUE(said == "state FILE is no saved state" ||
                said ==
                    "state FILE is damaged: its checksum is not that of what it holds; "
                    "truncated?")
        << said;
  }
  std::string flipped = good;
  flipped[good.size() / 3] ^= 4;
  writeBytes(folder.path("flipped"), flipped);
  EXPECT_EQ(complaint(scene, folder.path("flipped")),
            "state FILE is damaged: its checksum is not that of what it holds; truncated?");
  for (const auto& change : std::vector<std::function<void(SceneConfig&)>>{
           [](SceneConfig& c) { c.time_step_s = 0.02; },
           [](SceneConfig& c) { c.contacts[0].friction = 0.1; },
           [](SceneConfig& c) {
             c.tools[0].name = "probe";
             c.contacts[0].other = "probe";
           },
           [](SceneConfig& c) { c.tissues[0].pose.position_m.x() += 1e-9; },
           [](SceneConfig& c) { c.solver.stepper = Stepper::bdf2; }})
  {
    SceneConfig other = config;
    change(other);
    Scene another(other);
    EXPECT_EQ(complaint(another, file), "state FILE is the state of another scene");
  }
  scene.step();
  untouched.step();
  expectSame(scene, untouched);
}

// Its checksum is right, and what it is a state of.
TEST(StateFile, ThatFitsNotToTheEndLeavesTheSceneAsItWas)
{
  const ScratchFolder folder;
  SceneConfig config = stroked(folder);
  Scene scene(config), untouched(config);
  for (int k = 0; k < 8; ++k)
  {
    scene.step();
    untouched.step();
  }
  // Another name for the section that is read last, and the sum right again.
  scene.saveState(folder.path("state"));
  std::string bytes = readBytes(folder.path("state"));
  const std::size_t at = bytes.find("report");
  ASSERT_NE(at, std::string::npos);
  bytes.replace(at, 6, "repert");
  bytes.resize(bytes.size() - 8);
  StateHash hash;
  hash.add(bytes.data(), bytes.size());
  const std::uint64_t sum = hash.value();
  bytes.append(reinterpret_cast<const char*>(&sum), 8);
  writeBytes(folder.path("bad"), bytes);
  EXPECT_EQ(complaint(scene, folder.path("bad")), "state FILE has no section 'report'");
  for (int k = 0; k < 5; ++k)
  {
    scene.step();
    untouched.step();
    expectSame(scene, untouched);
  }
}

TEST(StateFile, CanNotBeWrittenWhereThereIsNoFolder)
{
  const ScratchFolder folder;
  const Scene scene(stroked(folder));
  EXPECT_THROW(scene.saveState(folder.path("gone") + "/state"), Error);
}

}  // namespace
}  // namespace soft_tissue::test
