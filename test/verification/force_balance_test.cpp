#include <gtest/gtest.h>

#include <cstdio>

#include "support/scene_forces.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** A tool over a tissue fixed at its bottom. */
struct Press
{
  std::string name;
  bool lobe;
  ShapeGeometry shape;
  Vec3 turned;  ///< roll, pitch, yaw, rad
};

void PrintTo(const Press& press, std::ostream* out)
{
  *out << press.name;
}

std::vector<Press> presses()
{
  std::vector<Press> all;
  for (const bool lobe : {false, true})
  {
    const std::string on = lobe ? "_on_lobe" : "_on_block";
    all.push_back({"sphere" + on, lobe, SphereShape{0.008}, Vec3::Zero()});
    all.push_back({"capsule" + on, lobe, CapsuleShape{0.005, 0.02}, {0.2, 1.4, 0.5}});
    all.push_back({"box" + on, lobe, BoxShape{{0.016, 0.012, 0.014}}, {0.2, -0.1, 0.4}});
  }
  return all;
}

std::shared_ptr<const RigidShape> makeShape(const ShapeGeometry& geometry)
{
  if (const auto* sphere = std::get_if<SphereShape>(&geometry))
  {
    return makeSphere(sphere->radius_m);
  }
  if (const auto* capsule = std::get_if<CapsuleShape>(&geometry))
  {
    return makeCapsule(capsule->radius_m, capsule->length_m);
  }
  return makeBox(std::get<BoxShape>(geometry).size_m);
}

/** The scene of a press, its tool half a millimetre above the tissue. */
SceneConfig pressScene(const ScratchFolder& folder, const Press& press, Response response)
{
  SceneConfig config = press.lobe ? lobeScene() : blockScene(folder, {8, 8, 4});
  fixBelow(config, 0.001);
  PoseConfig start;
  start.rotation_rpy_rad = press.turned;
  start.position_m = press.lobe ? kLobeSpot : Vec3(0.003, -0.002, 0.0);
  start.position_m.z() =
      (press.lobe ? kLobeTop : kBlockTop) + reachDown(press.shape, start) + 0.0005;
  addTool(config, press.shape, start, response);
  config.solver.tolerance = 1e-6;
  config.solver.max_iterations = 100;
  config.solver.linear = LinearSolverKind::pcg;
  return config;
}

/** A tool's way down, and a little to the side. */
class Descent
{
 public:
  explicit Descent(const Scene& scene)
  {
    Snapshot snapshot;
    scene.fillSnapshot(snapshot);
    start_ = snapshot.tools[0].X_WT;
  }
  /** The pose after a share of it in [0, 1]. */
  Pose at(double share) const
  {
    Pose goal = raised(start_, -0.004 * share);
    goal.translation().x() += 0.002 * share;
    return goal;
  }

 private:
  Pose start_;
};

/** Lowers the tool in so many steps, then holds it until nothing moves any more. */
void pressUntilRest(Scene& scene, int steps, Snapshot& snapshot)
{
  const Descent descent(scene);
  constexpr int kMost = 500;
  constexpr double kRest = 1e-10;  // m, in a step
  Points before;
  for (int k = 1; k <= kMost; ++k)
  {
    scene.setToolTarget(0, descent.at(std::min(1.0, 1.0 * k / steps)));
    ASSERT_FALSE(scene.step().held) << "step " << k;
    scene.fillSnapshot(snapshot);
    const Points& x = snapshot.tissues[0].positions;
    double moved = k > steps ? 0.0 : 1.0;
    for (std::size_t i = 0; k > steps && i < x.size(); ++i)
    {
      moved = std::max(moved, (x[i] - before[i]).norm());
    }
    if (moved < kRest)
    {
      return;
    }
    before = x;
  }
  FAIL() << "no rest after " << kMost << " steps";
}

class ForceBalance : public ::testing::TestWithParam<std::tuple<Press, Response>>
{
 protected:
  Press press() const { return std::get<0>(GetParam()); }
  Response response() const { return std::get<1>(GetParam()); }
  ScratchFolder folder_;
};

std::string nameOf(const ::testing::TestParamInfo<std::tuple<Press, Response>>& info)
{
  return std::get<0>(info.param).name +
         (std::get<1>(info.param) == Response::segment ? "_segment" : "_point");
}

INSTANTIATE_TEST_SUITE_P(All, ForceBalance,
                         ::testing::Combine(::testing::ValuesIn(presses()),
                                            ::testing::Values(Response::point, Response::segment)),
                         nameOf);

TEST_P(ForceBalance, ToolFeelsTheOppositeOfWhatTheNodesFeel)
{
  Scene scene(pressScene(folder_, press(), response()));
  ContactTwin twin(scene, makeShape(press().shape));
  const Descent descent(scene);
  Snapshot before, after;
  scene.fillSnapshot(after);
  double worst_force = 0.0, worst_moment = 0.0;
  constexpr int kSteps = 12;
  for (int k = 1; k <= kSteps; ++k)
  {
    scene.fillSnapshot(before);
    scene.setToolTarget(0, descent.at(1.0 * k / kSteps));
    scene.step();
    scene.fillSnapshot(after);
    ASSERT_FALSE(after.report.held);
    ASSERT_EQ(after.report.halvings, 0);
    const Load nodes = twin.onNodes(before.tissues[0].positions, before.tools[0].X_WT,
                                    after.tissues[0].positions, after.tools[0].X_WT);
    const Load tool = loadOn(after.tools[0]);
    const double force = (tool.force + nodes.force).norm();
    const double moment = (tool.moment + nodes.moment).norm();
    EXPECT_LE(force, 1e-9 * nodes.size) << "step " << k;
    EXPECT_LE(moment, 1e-9 * nodes.size * kBlockTop) << "step " << k;
    if (nodes.size > 0.0)
    {
      worst_force = std::max(worst_force, force / nodes.size);
      worst_moment = std::max(worst_moment, moment / (nodes.size * kBlockTop));
    }
  }
  std::printf("  tool against nodes: force off by at most %.1e, moment %.1e\n", worst_force,
              worst_moment);
  EXPECT_GT(after.tools[0].wrench_W.force.z(), 0.05);
}

TEST_P(ForceBalance, ContactsAddUpToTheWrench)
{
  Scene scene(pressScene(folder_, press(), response()));
  Snapshot snapshot;
  const Descent descent(scene);
  for (int k = 1; k <= 12; ++k)
  {
    scene.setToolTarget(0, descent.at(k / 12.0));
    scene.step();
  }
  scene.fillSnapshot(snapshot);
  Load contacts;
  for (const ContactPoint& contact : snapshot.tools[0].contacts)
  {
    contacts.add(contact.position_W, contact.force_W);
    EXPECT_NEAR(contact.normal_W.norm(), 1.0, 1e-12);
    EXPECT_GE(contact.depth, 0.0);
    EXPECT_LE(contact.depth, snapshot.report.max_penetration_m);
    EXPECT_EQ(contact.tissue, 0);
  }
  EXPECT_EQ(snapshot.report.contacts, static_cast<int>(snapshot.tools[0].contacts.size()));
  const Load tool = loadOn(snapshot.tools[0]);
  EXPECT_GT(contacts.size, 0.05);
  EXPECT_LT((tool.force - contacts.force).norm(), 1e-12 * contacts.size);
  EXPECT_LT((tool.moment - contacts.moment).norm(), 1e-12 * contacts.size * kBlockTop);
}

// Static, and dynamic once all has come to rest: the tool has what the support and the weight
// leave. Smooth tools have one equilibrium, found either way; beside the edges of a box tissue can
// lie on either face, so that where it rests depends on how it came there.
TEST_P(ForceBalance, HeldToolCarriesTheLoadOfTheEquilibrium)
{
  for (const double gravity : {0.0, -9.81})
  {
    Load tools[2];
    for (const bool dynamic : {false, true})
    {
      SceneConfig config = pressScene(folder_, press(), response());
      config.gravity_m_per_s2.z() = gravity;
      config.solver.stepper = dynamic ? Stepper::implicit_euler : Stepper::quasi_static;
      config.time_step_s = 0.02;
      config.solver.tolerance = 1e-9;
      Scene scene(config);
      Snapshot snapshot;
      ASSERT_NO_FATAL_FAILURE(pressUntilRest(scene, 8, snapshot));
      TissueForces forces(scene);
      const Points& x = snapshot.tissues[0].positions;
      const Load tool = loadOn(snapshot.tools[0]);
      const Load support = forces.support(x);
      const Load weight = forces.weight(x);
      const std::string which = std::string(dynamic ? "dynamic" : "static") + ", gravity " +
                                testing::PrintToString(gravity);
      EXPECT_TRUE(snapshot.report.converged) << which << ": " << snapshot.report.residual;
      std::printf("  %s: %.4f N, tool against support and weight off by %.1e\n", which.c_str(),
                  tool.force.norm(),
                  (support.force + weight.force - tool.force).norm() / tool.size);
      EXPECT_GT(tool.force.z(), 0.03) << which;
      EXPECT_LT((support.force + weight.force - tool.force).norm(), 1e-4 * tool.size) << which;
      EXPECT_LT((support.moment + weight.moment - tool.moment).norm(), 1e-4 * tool.size * kBlockTop)
          << which;
      tools[dynamic ? 1 : 0] = tool;
    }
    std::printf("  dynamic against static: off by %.1e\n",
                (tools[1].force - tools[0].force).norm() / tools[0].size);
    if (!std::holds_alternative<BoxShape>(press().shape))
    {
      EXPECT_LT((tools[1].force - tools[0].force).norm(), 1e-5 * tools[0].size) << gravity;
      EXPECT_LT((tools[1].moment - tools[0].moment).norm(), 1e-5 * tools[0].size * kBlockTop)
          << gravity;
    }
  }
}

class LyingTissue : public ::testing::TestWithParam<Response>
{};

INSTANTIATE_TEST_SUITE_P(All, LyingTissue, ::testing::Values(Response::point, Response::segment));

TEST_P(LyingTissue, PressesItsTableWithItsWeight)
{
  ScratchFolder folder;
  SceneConfig config = blockScene(folder, {6, 6, 3});
  PoseConfig table;
  table.position_m = Vec3(0.0, 0.0, -0.0105);
  addTool(config, BoxShape{{0.2, 0.2, 0.02}}, table, GetParam());
  config.gravity_m_per_s2.z() = -9.81;
  config.time_step_s = 0.02;
  config.solver.tolerance = 1e-7;
  config.solver.max_iterations = 100;
  Scene scene(config);
  Snapshot snapshot;
  for (int k = 0; k < 200; ++k)
  {
    ASSERT_FALSE(scene.step().held) << "step " << k;
  }
  scene.fillSnapshot(snapshot);
  const Load weight = TissueForces(scene).weight(snapshot.tissues[0].positions);
  const Load tool = loadOn(snapshot.tools[0]);
  std::printf("  %.4f N, off the weight by %.1e\n", tool.force.norm(),
              (tool.force - weight.force).norm() / weight.size);
  EXPECT_NEAR(weight.force.z(), -9.81 * 1000.0 * 0.06 * 0.06 * kBlockTop, 1e-9);
  EXPECT_LT((tool.force - weight.force).norm(), 1e-4 * weight.size);
  EXPECT_LT((tool.moment - weight.moment).norm(), 1e-4 * weight.size * kBlockTop);
}

}  // namespace
}  // namespace soft_tissue
