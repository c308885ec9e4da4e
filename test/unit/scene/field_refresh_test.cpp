#include <gtest/gtest.h>

#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kRadius = 0.008;  // m

/** A lobe under a ball whose depth comes from nodal depths, so that it matters when they are taken.
 */
SceneConfig lobeUnderBall(FieldRefresh refresh)
{
  SceneConfig config = lobeScene();
  fixBelow(config, 0.001);
  config.tissues[0].field.depth = DepthKind::interpolated;
  config.tissues[0].field.refresh = refresh;
  PoseConfig start;
  start.position_m = kLobeSpot + (kLobeTop + kRadius + 0.0005) * Vec3::UnitZ();
  addTool(config, SphereShape{kRadius}, start, Response::segment);
  return config;
}

/** Presses the ball 4 mm down and back up, as often as asked, and returns the shape at the lowest
 * point of the last time. */
Points pressed(Scene& scene, int times)
{
  constexpr int kSteps = 20;
  const Pose start = scene.config().tools[0].initial_pose.toPose();
  Snapshot snapshot;
  for (int press = 0; press < times; ++press)
  {
    scene.resetWorld();
    for (int n = 1; n <= kSteps; ++n)
    {
      scene.setToolTarget(0, raised(start, -0.0045 * n / kSteps));
      scene.step();
    }
    scene.fillSnapshot(snapshot);
    EXPECT_GT(snapshot.report.contacts, 0);
  }
  return snapshot.tissues[0].positions;
}

TEST(FieldRefresh, CarriedDepthsAreThoseOfTheRestStateWhateverHappenedSince)
{
  Scene once(lobeUnderBall(FieldRefresh::carried)), thrice(lobeUnderBall(FieldRefresh::carried));
  EXPECT_EQ(pressed(once, 1), pressed(thrice, 3));
}

TEST(FieldRefresh, CarriedDepthsAreNotThoseOfTheDeformedMesh)
{
  Scene carried(lobeUnderBall(FieldRefresh::carried)), lazy(lobeUnderBall(FieldRefresh::lazy));
  EXPECT_NE(pressed(carried, 1), pressed(lazy, 1));
}

TEST(FieldRefresh, LazyAndFullMarchesGiveTheSameBits)
{
  Scene lazy(lobeUnderBall(FieldRefresh::lazy)), full(lobeUnderBall(FieldRefresh::full));
  EXPECT_EQ(pressed(lazy, 1), pressed(full, 1));
}

TEST(FieldRefresh, OnlyFullMarchesWhereNothingTouches)
{
  for (const FieldRefresh refresh : {FieldRefresh::carried, FieldRefresh::lazy, FieldRefresh::full})
  {
    Scene scene(lobeUnderBall(refresh));
    scene.step();
    const bool marched = scene.step().ms.field > 0.0;
    EXPECT_EQ(marched, refresh == FieldRefresh::full);
  }
}

TEST(FieldRefresh, AGridsDepthsServeAContactAsExactOnesDo)
{
  SceneConfig config = lobeUnderBall(FieldRefresh::full);
  Scene exact(config);
  config.tissues[0].field.method = "grid";
  config.tissues[0].field.grid_points = 60;
  Scene grid(config);
  const Points exactly = pressed(exact, 1), on_grid = pressed(grid, 1);
  EXPECT_NE(exactly, on_grid);
  double largest = 0.0;
  for (std::size_t i = 0; i < exactly.size(); ++i)
  {
    largest = std::max(largest, (exactly[i] - on_grid[i]).norm());
  }
  EXPECT_LT(largest, 0.03 * 0.004) << "of a press of 4 mm";
}

}  // namespace
}  // namespace soft_tissue
