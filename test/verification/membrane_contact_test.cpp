#include <gtest/gtest.h>

#include <cstdio>

#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kSide = 0.1, kRadius = 0.01, kDeepest = 0.0005;

/** A sheet of rubber, 1 mm thick, held at all its sides; `cells` along each. */
SceneConfig heldSheet(const ScratchFolder& folder, int cells)
{
  SceneConfig config;
  config.file = "sheet scene";
  config.time_step_s = 0.01;
  config.gravity_m_per_s2.setZero();
  const std::string file = folder.path("sheet" + std::to_string(cells) + ".stl");
  saveStl(file, makeSheet({cells, cells}, {kSide, kSide}, SheetPattern::irregular));
  MembraneConfig sheet;
  sheet.name = "sheet";
  sheet.mesh.file = file;
  sheet.pose.position_m = Vec3(-0.5 * kSide, -0.5 * kSide, 0.0);
  sheet.material = {MaterialModel::neo_hookean, 2e5, 0.45, 1000.0};
  sheet.thickness_m = 0.001;
  const double edge = 0.499 * kSide;
  for (const double s : {-1.0, 1.0})
  {
    const Vec3 low(std::min(s * edge, s), -1.0, -1.0), high(std::max(s * edge, s), 1.0, 1.0);
    sheet.fixed.push_back({low, high});
    sheet.fixed.push_back({Vec3(low.y(), low.x(), -1.0), Vec3(high.y(), high.x(), 1.0)});
  }
  config.membranes.push_back(sheet);
  return config;
}

/** A soft ball above the sheet. */
TissueConfig& addBall(const ScratchFolder& folder, SceneConfig& config, double height)
{
  TissueConfig& ball =
      addTissue(config, "ball", saved(folder, "ball.msh", makeBall(kRadius, 1000)), Vec3::Zero());
  ball.pose.position_m = Vec3(0.004, -0.003, height);
  ball.material = {MaterialModel::neo_hookean, 2e4, 0.4, 1000.0};
  return ball;
}

double weightOf(const TetMesh& mesh, double density)
{
  double volume = 0.0;
  for (const Tet& t : mesh.tets)
  {
    volume +=
        signedVolume6(mesh.nodes[t[0]], mesh.nodes[t[1]], mesh.nodes[t[2]], mesh.nodes[t[3]]) / 6.0;
  }
  return 9.81 * density * volume;
}

// At 2 m/s a step goes a ball's diameter.
TEST(MembraneContact, ThrownBallIsCaught)
{
  for (const int cells : {3, 24})
  {
    for (const Response response : {Response::point, Response::segment})
    {
      const ScratchFolder folder;
      SceneConfig config = heldSheet(folder, cells);
      addBall(folder, config, 0.03).velocity_m_per_s = Vec3(0.0, 0.0, -2.0);
      addPair(config, "sheet", "ball", response);
      Scene scene(config);
      Snapshot state;
      double lowest = 1.0, back = 0.0, deepest = 0.0;
      int held = 0;
      for (int step = 0; step < 60; ++step)
      {
        held += scene.step().held ? 1 : 0;
        scene.fillSnapshot(state);
        deepest = std::max(deepest, state.report.max_penetration_m);
        for (const Vec3& p : state.tissues[0].positions)
        {
          lowest = std::min(lowest, p.z());
        }
        Vec3 mean = Vec3::Zero();
        for (const Vec3& v : state.tissues[0].velocities)
        {
          mean += v / static_cast<double>(state.tissues[0].velocities.size());
        }
        back = mean.z();
      }
      std::printf(
          "  %d cells, %s: ball got down to %.1f mm, goes at %.2f m/s; deepest %.3f mm; %d held\n",
          cells, response == Response::point ? "points" : "segments", 1e3 * lowest, back,
          1e3 * deepest, held);
      EXPECT_GT(centreOf(state.tissues[0]).z(), 0.0);
      EXPECT_GT(back, 0.0);
      EXPECT_EQ(held, 0);
    }
  }
}

// Triangles of 33 mm don't give way around a ball of 3 mm: it takes 13 N to pull them down.
TEST(MembraneContact, RigidBallAtTwoMetresPerSecondIsCaught)
{
  for (const int cells : {3, 24})
  {
    const ScratchFolder folder;
    SceneConfig config = heldSheet(folder, cells);
    PoseConfig start;
    start.position_m = Vec3(0.004, -0.003, 0.05);
    addTool(config, SphereShape{0.003}, start, Response::segment);
    config.contacts.back().tissue = "sheet";
    config.contacts.back().stiffness_pa_per_m.reset();
    config.contacts.back().max_penetration_m = kDeepest;
    Scene scene(config);
    Snapshot state;
    Pose X_WT = start.toPose();
    int held = 0;
    for (int step = 0; step < 4; ++step)
    {
      X_WT.translation().z() -= 0.02;
      scene.setToolTarget(0, X_WT);
      held += scene.step().held ? 1 : 0;
    }
    scene.fillSnapshot(state);
    std::printf("  %d cells: %.3f N on the ball, %.3f mm deep, %d held\n", cells,
                state.tools[0].wrench_W.force.z(), 1e3 * state.report.max_penetration_m, held);
    EXPECT_EQ(held, 0);
    EXPECT_GT(state.tools[0].wrench_W.force.z(), 1.0);
    EXPECT_LE(state.report.max_penetration_m, kDeepest);
  }
}

// The ball hangs in the sheet; what the sheet holds at its sides is both weights.
TEST(MembraneContact, BallInASheetIsCarried)
{
  for (const Response response : {Response::point, Response::segment})
  {
    const ScratchFolder folder;
    SceneConfig config = heldSheet(folder, 16);
    config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    config.time_step_s = 0.02;
    config.solver.tolerance = 1e-6;
    addBall(folder, config, 0.0102);
    addPair(config, "sheet", "ball", response);
    Scene scene(config);
    for (int step = 0; step < 150; ++step)
    {
      scene.step();
    }
    Snapshot state;
    scene.fillSnapshot(state);
    const double weight = weightOf(scene.tissues()[0].rest, 1000.0);
    const Vec3 on_sheet = forceOnFirst(state.tissue_pairs[0]);
    std::printf("  %s: presses with %.6f N of %.6f, %.1e aside; rms speed %.1e m/s\n",
                response == Response::point ? "points" : "segments", -on_sheet.z(), weight,
                on_sheet.head<2>().norm(), rmsSpeed(state));
    EXPECT_NEAR(-on_sheet.z(), weight, 1e-3 * weight);
  }
}

}  // namespace
}  // namespace soft_tissue::test
