#include <gtest/gtest.h>

#include <cstdio>

#include "support/voxel_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kCell = 0.004;
constexpr double kRadius = 0.02;

/** Kinetic energy of a tissue of so many kg/m^3, as if its mass were spread over its nodes, J. */
double kineticEnergy(const Snapshot& snapshot, double mass)
{
  const double speed = rmsSpeed(snapshot);
  return 0.5 * mass * speed * speed;
}

struct Course
{
  double most_energy = 0.0, least_det = 1.0, fastest = 0.0;
  int held = 0;
  Snapshot last;
};

Course follow(Scene& scene, int steps, double mass)
{
  Course course;
  for (int k = 0; k < steps; ++k)
  {
    course.held += scene.step().held ? 1 : 0;
    scene.fillSnapshot(course.last);
    course.most_energy = std::max(course.most_energy, kineticEnergy(course.last, mass));
    course.fastest = std::max(course.fastest, rmsSpeed(course.last));
    course.least_det = std::min(course.least_det, course.last.report.min_det_f);
  }
  return course;
}

// Elastic energy of contact at that depth, let go at once, would be thousands of times as much.
TEST(Swallowed, AFreeBallIsPushedOutOfTheMapThatTookItInWithoutABurst)
{
  const double mass = 1000.0 * 4.0 / 3.0 * M_PI * kRadius * kRadius * kRadius;
  for (const Response response : {Response::point, Response::segment})
  {
    for (const double share : {0.2, 0.8})
    {
      const ScratchFolder folder;
      SceneConfig config = tissueScene(saved(folder, "ball.msh", makeBall(kRadius, 500)));
      config.tissues[0].material.young_modulus_pa = 2e4;
      addLiveMap(config, kCell, response);
      Scene scene(config);
      follow(scene, 5, mass);
      VoxelSet cells(kCell);
      const double top = kRadius * (2.0 * share - 1.0);
      cells.fill({Cell(-20, -20, -30), Cell(20, 20, int(std::round(top / kCell)))}, true);
      scene.setObstacleCells(0, cells);
      const Course course = follow(scene, 400, mass);
      const double speed = 2.5 * kCell;  // half cells a second that it is let, see docs/methods.md
      std::printf(
          "  %s, %.1f taken in: at most %.1f mm/s, %.2g J, least det F %.2f, %d held, %.4f mm deep "
          "in the end, %.1f mm up\n",
          response == Response::point ? "points" : "segments", share, 1e3 * course.fastest,
          course.most_energy, course.least_det, course.held,
          1e3 * course.last.report.max_penetration_m, 1e3 * centreOf(course.last.tissues[0]).z());
      EXPECT_LT(course.most_energy, 0.5 * mass * 9.0 * speed * speed);
      EXPECT_GT(course.least_det, 0.3);
      EXPECT_EQ(course.held, 0);
      EXPECT_GT(centreOf(course.last.tissues[0]).z(), top + 0.97 * kRadius);
      EXPECT_LT(course.last.report.max_penetration_m, 0.05 * kCell);
    }
  }
}

// A wall of one cell appears across a block that is held: its nodes are to either side of it.
TEST(Swallowed, AHeldBlockGivesWayToAPole)
{
  for (const Response response : {Response::point, Response::segment})
  {
    const ScratchFolder folder;
    SceneConfig config = blockScene(folder, {5, 5, 3});
    config.tissues[0].material.young_modulus_pa = 2e4;
    fixBelow(config, 1e-6);
    addLiveMap(config, kCell, response);
    Scene scene(config);
    VoxelSet cells(kCell);
    cells.fill({Cell(-2, -2, 3), Cell(2, 2, 20)}, true);
    scene.setObstacleCells(0, cells);
    const double mass = 1000.0 * 0.06 * 0.06 * 0.03;
    const Course course = follow(scene, 200, mass);
    std::printf("  %s: at most %.1f mm/s, %.2g J, least det F %.2f, %d held, %.3f mm deep\n",
                response == Response::point ? "points" : "segments", 1e3 * course.fastest,
                course.most_energy, course.least_det, course.held,
                1e3 * course.last.report.max_penetration_m);
    EXPECT_LT(course.fastest, 5.0 * kCell);
    EXPECT_GT(course.least_det, 0.05);
    EXPECT_EQ(course.held, 0);
  }
}

// A map that flickers, as those of cameras do, must not shake what lies on it.
TEST(Swallowed, AFloorThatFlickersCarriesOn)
{
  const ScratchFolder folder;
  SceneConfig config = blockScene(folder, {6, 6, 3});
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
  addLiveMap(config, kCell, Response::segment);
  Scene scene(config);
  VoxelSet floor(kCell);
  floor.fill({Cell(-12, -12, -4), Cell(12, 12, 0)}, true);
  scene.setObstacleCells(0, floor);
  const double mass = 1000.0 * 0.06 * 0.06 * 0.03;
  follow(scene, 50, mass);
  Course all;
  for (int round = 0; round < 30; ++round)
  {
    VoxelSet cells = floor;
    const int x = round * 5 % 14 - 7, y = round * 3 % 14 - 7;
    cells.fill({Cell(x, y, 0), Cell(x + 2, y + 2, 1)}, round % 2 == 0);
    scene.setObstacleCells(0, cells);
    const Course course = follow(scene, 3, mass);
    all.fastest = std::max(all.fastest, course.fastest);
    all.least_det = std::min(all.least_det, course.least_det);
    all.held += course.held;
  }
  std::printf("  at most %.1f mm/s, least det F %.2f, %d held\n", 1e3 * all.fastest, all.least_det,
              all.held);
  EXPECT_LT(all.fastest, 5.0 * kCell);
  EXPECT_GT(all.least_det, 0.3);
  EXPECT_EQ(all.held, 0);
}

}  // namespace
}  // namespace soft_tissue::test
