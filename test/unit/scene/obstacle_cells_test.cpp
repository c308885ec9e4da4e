#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/base/error.h"
#include "support/voxel_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kCell = 0.005;
const CellBox kFloor = {Cell(-12, -12, -4), Cell(12, 12, 0)};

VoxelSet floorCells()
{
  VoxelSet cells(kCell);
  cells.fill(kFloor, true);
  return cells;
}

bool isFloor(const Vec3& p)
{
  return p.z() < 0.0;
}

class ObstacleCells : public testing::Test
{
 protected:
  /** A block on the ground, or where it would be. */
  SceneConfig block(Response response = Response::segment)
  {
    SceneConfig config = blockScene(folder_, {4, 4, 2});
    config.gravity_m_per_s2 = Vec3(0.0, 0.0, -9.81);
    addLiveMap(config, kCell, response);
    return config;
  }

  static Snapshot run(Scene& scene, int steps)
  {
    for (int k = 0; k < steps; ++k)
    {
      scene.step();
    }
    Snapshot snapshot;
    scene.fillSnapshot(snapshot);
    return snapshot;
  }

  ScratchFolder folder_;
};

TEST_F(ObstacleCells, UntilTheFirstMapThereIsNothing)
{
  SceneConfig config = block();
  config.obstacles[0].octomap.unknown_occupied = true;
  Scene scene(config);
  const Snapshot fallen = run(scene, 20);
  EXPECT_NEAR(centreOf(fallen.tissues[0]).z(), 0.5 * kBlockTop - 0.5 * 9.81 * 0.2 * 0.2, 0.02);
  EXPECT_TRUE(fallen.obstacles[0].contacts.empty());
}

// A block that touches nothing when the cells come has been allowed nothing by them.
TEST_F(ObstacleCells, CellsFromOutsideActAsThoseOfAFile)
{
  for (const Response response : {Response::point, Response::segment})
  {
    SceneConfig config = block(response);
    config.tissues[0].pose.position_m.z() = 0.0011;
    Scene live(config);
    EXPECT_TRUE(live.setObstacleCells(0, floorCells()).bounds().empty());
    config.obstacles.clear();
    config.contacts.clear();
    addMap(config, savedMap(folder_, kCell, kFloor, isFloor), response);
    Scene filed(config);
    EXPECT_EQ(run(live, 100).tissues[0].positions, run(filed, 100).tissues[0].positions);
    EXPECT_EQ(live.stateHash(), filed.stateHash());
    EXPECT_EQ(live.obstacles()[0].surface.nodes, filed.obstacles()[0].surface.nodes);
  }
}

TEST_F(ObstacleCells, TheSameMapAgainChangesNoBit)
{
  Scene one(block()), other(block());
  one.setObstacleCells(0, floorCells());
  other.setObstacleCells(0, floorCells());
  run(one, 10);
  run(other, 10);
  EXPECT_EQ(one.setObstacleCells(0, floorCells()).contents(), floorCells().contents());
  run(one, 20);
  run(other, 20);
  EXPECT_EQ(one.stateHash(), other.stateHash());
}

TEST_F(ObstacleCells, CountInTheStateHash)
{
  Scene one(block()), other(block());
  one.setObstacleCells(0, floorCells());
  VoxelSet cells = floorCells();
  cells.set({200, 200, 5}, true);  // far from everything
  other.setObstacleCells(0, cells);
  EXPECT_NE(one.stateHash(), other.stateHash());
  other.setObstacleCells(0, floorCells());
  EXPECT_EQ(one.stateHash(), other.stateHash());
  other.setObstacle(0, floorCells(), Pose(Eigen::Translation3d(0.0, 0.0, -1.0)));
  EXPECT_NE(one.stateHash(), other.stateHash());
}

TEST_F(ObstacleCells, AMapMayBeMoved)
{
  Scene scene(block());
  scene.setObstacle(0, floorCells(), Pose(Eigen::Translation3d(0.0, 0.0, -0.02)));
  EXPECT_NEAR(centreOf(run(scene, 300).tissues[0]).z(), 0.5 * kBlockTop - 0.02, 0.003);
  scene.setObstacle(0, floorCells(), Pose(Eigen::Translation3d(0.0, 0.0, -0.03)));
  EXPECT_NEAR(centreOf(run(scene, 300).tissues[0]).z(), 0.5 * kBlockTop - 0.03, 0.003);
}

TEST_F(ObstacleCells, WakeWhatSleepsNearThem)
{
  SceneConfig config = block();
  config.solver.sleep = SleepConfig{1e-3, 0.1, 0.1};
  config.solver.tolerance = 1e-6;
  config.tissues[0].material.mass_damping_per_s = 20.0;
  Scene scene(config);
  VoxelSet cells = floorCells();
  cells.set({200, 200, 5}, true);
  scene.setObstacleCells(0, cells);
  ASSERT_TRUE(run(scene, 100).tissues[0].asleep);
  cells.set({200, 200, 5}, false);
  scene.setObstacleCells(0, cells);
  EXPECT_TRUE(run(scene, 1).tissues[0].asleep) << "that is far away";
  scene.setObstacleCells(0, VoxelSet(kCell));
  const Snapshot falling = run(scene, 20);
  EXPECT_FALSE(falling.tissues[0].asleep);
  EXPECT_LT(centreOf(falling.tissues[0]).z(), 0.0);
}

// What is in cells that came later is in them after a reset too.
TEST_F(ObstacleCells, ResetsIntoCellsThatCameLater)
{
  Scene scene(block());
  VoxelSet cells = floorCells();
  cells.fill({Cell(-12, -12, 0), Cell(12, 12, 3)}, true);  // half of the block
  scene.setObstacleCells(0, cells);
  const Snapshot first = run(scene, 50);
  scene.resetWorld();
  const Snapshot again = run(scene, 50);
  EXPECT_EQ(first.tissues[0].positions, again.tissues[0].positions);
}

TEST_F(ObstacleCells, RefusesWhatDoesNotFit)
{
  Scene scene(block());
  const auto complaint = [](const auto& act) -> std::string {
    try
    {
      act();
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(
      complaint([&] { scene.setObstacleCells(0, VoxelSet(0.01)); }),
      "small scene: obstacles[0] 'map' has cells of 0.005000 m, given are some of 0.010000 m");
  Pose scaled = Pose::Identity();
  scaled.linear() *= 2.0;
  EXPECT_EQ(complaint([&] { scene.setObstacle(0, VoxelSet(kCell), scaled); }),
            "small scene: obstacles[0] 'map': a pose to set must be a rotation and a finite "
            "translation");
  EXPECT_THROW(scene.setObstacleCells(1, VoxelSet(kCell)), std::out_of_range);
}

}  // namespace
}  // namespace soft_tissue::test
