#include <gtest/gtest.h>

#include <cstdio>

#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kTimeStep = 0.01;                       // s
constexpr double kSheet = 0.005, kWide = 0.06;           // m
constexpr double kNeedle = 0.001, kNeedleLength = 0.04;  // m: radius, and between the caps

/** A sheet around the z axis, its top at z = 0, held at its rim. */
SceneConfig sheetScene(const ScratchFolder& folder)
{
  const std::string file = folder.path("sheet.msh");
  saveGmsh(file, makeBox({16, 16, 2}, {kWide, kWide, kSheet}));
  SceneConfig config = tissueScene(file);
  config.tissues[0].pose.position_m = Vec3(-0.5 * kWide, -0.5 * kWide, -kSheet);
  const double rim = 0.5 * kWide - 0.004;
  for (const double side : {-1.0, 1.0})
  {
    for (const int axis : {0, 1})
    {
      BoxConfig box{Vec3::Constant(-1.0), Vec3::Constant(1.0)};
      (side < 0.0 ? box.max : box.min)[axis] = side * rim;
      config.tissues[0].fixed.push_back(box);
    }
  }
  config.time_step_s = kTimeStep;
  return config;
}

struct Shot
{
  double lowest_above = 1.0;  ///< lowest place of the sheet's upper side below the tip, over it, m
  bool held = false;
  int parts = 0;
  double highest_speed = 0.0;  ///< of a node at the end, m/s
};

/** Shoots a needle of a radius of 1 mm, point first, through where the sheet is. */
Shot shoot(double speed, double reach, Response response)
{
  const ScratchFolder folder;
  SceneConfig config = sheetScene(folder);
  PoseConfig start;
  start.position_m = Vec3(0.0005, 0.0003, 0.5 * kNeedleLength + kNeedle + 0.004);
  addTool(config, CapsuleShape{kNeedle, kNeedleLength}, start, response);
  config.contacts[0].stiffness_pa_per_m.reset();
  Scene scene(config);
  Pose X = start.toPose();
  const double stop = X.translation().z() - reach;
  Shot shot;
  for (int k = 0; k < 60; ++k)
  {
    X.translation().z() = std::max(X.translation().z() - speed * kTimeStep, stop);
    scene.setToolTarget(0, X);
    const StepReport& report = scene.step();
    shot.held = shot.held || report.held;
    shot.parts = std::max(shot.parts, report.parts);
  }
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  const Points& x = snapshot.tissues[0].positions;
  const Points& rest = scene.tissues()[0].rest.nodes;
  const double tip = X.translation().z() - 0.5 * kNeedleLength - kNeedle;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    if (std::abs(rest[i].z()) < 1e-9 && rest[i].head<2>().norm() < 2.0 * kNeedle)
    {
      shot.lowest_above = std::min(shot.lowest_above, x[i].z() - tip);
    }
  }
  std::printf(
      "  %.1f m/s, %s: upper side of the sheet %.2f mm above the tip, deepest contact %.2f mm, %d "
      "parts, "
      "tool force %.3f N\n",
      speed, response == Response::segment ? "segments" : "points", 1e3 * shot.lowest_above,
      1e3 * snapshot.report.max_penetration_m, shot.parts, snapshot.tools[0].wrench_W.force.z());
  return shot;
}

class FastTool : public testing::TestWithParam<Response>
{};

INSTANTIATE_TEST_SUITE_P(Responses, FastTool, testing::Values(Response::point, Response::segment));

TEST_P(FastTool, NeedleIsCaughtByASheetItCouldJumpThrough)
{
  for (const double speed : {0.2, 2.0})
  {
    const Shot shot = shoot(speed, 0.010, GetParam());
    EXPECT_FALSE(shot.held);
    EXPECT_LT(shot.lowest_above, 0.5 * kNeedle) << "the sheet's upper side is under the tip";
  }
}

}  // namespace
}  // namespace soft_tissue::test
