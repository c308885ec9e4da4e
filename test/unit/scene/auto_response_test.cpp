#include <gtest/gtest.h>

#include "support/small_scenes.h"

namespace soft_tissue::test
{
namespace
{
/** State after a ball was pressed into a block with edges of 7.5 to 13 mm. */
std::uint64_t pressed(double radius, Response response)
{
  const ScratchFolder folder;
  SceneConfig config = blockScene(folder, {8, 8, 4});
  fixBelow(config, 1e-6);
  PoseConfig start;
  start.position_m = Vec3(0.001, 0.002, kBlockTop + radius + 1e-4);
  addTool(config, SphereShape{radius}, start, response);
  Scene scene(config);
  for (int step = 1; step <= 3; ++step)
  {
    scene.setToolTarget(0, raised(start.toPose(), -0.001 * step));
    scene.step();
  }
  return scene.stateHash();
}

TEST(AutoResponse, IsPointsWhereEdgesAreShortForWhatTouches)
{
  const double large = 0.12;  // an eighth of it is 15 mm
  EXPECT_EQ(pressed(large, Response::automatic), pressed(large, Response::point));
  EXPECT_NE(pressed(large, Response::automatic), pressed(large, Response::segment));
}

TEST(AutoResponse, IsSegmentsElsewhere)
{
  const double small = 0.02;
  EXPECT_EQ(pressed(small, Response::automatic), pressed(small, Response::segment));
  EXPECT_NE(pressed(small, Response::automatic), pressed(small, Response::point));
}

}  // namespace
}  // namespace soft_tissue::test
