#include <gtest/gtest.h>

#include <cstdio>

#include "support/scene_forces.h"
#include "support/voxel_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kGravity = 9.81;

class VoxelFloor : public testing::TestWithParam<Response>
{
 protected:
  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Responses, VoxelFloor,
                         testing::Values(Response::point, Response::segment));

TEST_P(VoxelFloor, CarriesABlocksWeightAndLeavesItFlat)
{
  SceneConfig config = blockScene(folder_, {5, 5, 3});
  const CellBox box = {Cell(-20, -20, -3), Cell(20, 20, 3)};
  addMap(config, savedMap(folder_, 0.005, box, [](const Vec3& p) { return p.z() < 0.0; }),
         GetParam());
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -kGravity);
  config.time_step_s = 0.02;
  config.solver.tolerance = 1e-7;
  config.solver.max_iterations = 60;
  Scene scene(config);
  Snapshot snapshot;
  for (int k = 0; k < 300; ++k)
  {
    EXPECT_FALSE(scene.step().held) << "step " << k;
  }
  scene.fillSnapshot(snapshot);
  Load floor;
  for (const ContactPoint& point : snapshot.obstacles[0].contacts)
  {
    floor.add(point.position_W, point.force_W);
    EXPECT_EQ(point.tet, -1);
  }
  const Points& x = snapshot.tissues[0].positions;
  const Load weight = TissueForces(scene).weight(x);
  EXPECT_NEAR(floor.force.z() / weight.force.z(), 1.0, 1e-4);
  EXPECT_LT(floor.force.head<2>().norm(), 1e-4 * weight.size);
  double low = 1.0, high = -1.0;
  const Points& rest = scene.tissues()[0].rest.nodes;
  for (const Index node : scene.tissues()[0].surface.nodes)
  {
    if (rest[node].z() < 1e-9)
    {
      low = std::min(low, x[node].z());
      high = std::max(high, x[node].z());
    }
  }
  std::printf("  its bottom is between %.4f and %.4f mm\n", 1e3 * low, 1e3 * high);
  EXPECT_LT(high, 0.0);
  EXPECT_LT(high - low, 2e-5);
}

// The floor is flat, or a staircase that stands for a slope of 1 in 2; nodes alone are too far
// apart to feel its steps as a slope.
TEST_P(VoxelFloor, LetsABlockSlideDownAtTheRightAcceleration)
{
  for (const double slope : {0.0, 0.5})
  {
    if (slope > 0.0 && GetParam() == Response::point)
    {
      continue;
    }
    const double tilt = slope > 0.0 ? std::atan(slope) : 20.0 * M_PI / 180.0;
    const Vec3 normal = slope > 0.0 ? Vec3(std::sin(tilt), 0.0, std::cos(tilt)) : Vec3::UnitZ();
    const Vec3 down = Vec3::UnitY().cross(normal);
    SceneConfig config = blockScene(folder_, {5, 5, 3});
    const CellBox box = {Cell(-14, -12, -100), Cell(140, 12, 14)};
    addMap(config,
           savedMap(folder_, 0.003, box, [&](const Vec3& p) { return normal.dot(p) < 0.0; }),
           GetParam());
    if (slope > 0.0)
    {
      config.tissues[0].pose.rotation_rpy_rad.y() = tilt;
      config.tissues[0].pose.position_m = -0.03 * down - 0.03 * Vec3::UnitY() + 0.0015 * normal;
      config.gravity_m_per_s2 = Vec3(0.0, 0.0, -kGravity);
    }
    else
    {
      config.gravity_m_per_s2 = kGravity * Vec3(std::sin(tilt), 0.0, -std::cos(tilt));
    }
    config.time_step_s = 0.005;
    config.solver.tolerance = 1e-6;
    config.solver.max_iterations = 60;
    Scene scene(config);
    Snapshot snapshot;
    std::vector<double> speeds, heights;
    int unconverged = 0;
    for (int k = 0; k < 80; ++k)
    {
      const StepReport& step = scene.step();
      EXPECT_FALSE(step.held) << "step " << k;
      unconverged += step.converged ? 0 : 1;
      scene.fillSnapshot(snapshot);
      Vec3 speed = Vec3::Zero(), middle = Vec3::Zero();
      for (std::size_t i = 0; i < snapshot.tissues[0].positions.size(); ++i)
      {
        const double share = 1.0 / static_cast<double>(snapshot.tissues[0].positions.size());
        speed += share * snapshot.tissues[0].velocities[i];
        middle += share * snapshot.tissues[0].positions[i];
      }
      speeds.push_back(speed.dot(down));
      heights.push_back(middle.dot(normal));
    }
    const double found = (speeds[79] - speeds[19]) / (60 * config.time_step_s);
    const double expected = kGravity * std::sin(tilt);
    const auto [low, high] = std::minmax_element(heights.begin() + 40, heights.end());
    std::printf(
        "  slope %.1f: accelerates at %.4f m/s^2, expected %.4f; bobs by %.3f mm; %d of 80 "
        "steps unconverged\n",
        slope, found, expected, 1e3 * (*high - *low), unconverged);
    EXPECT_NEAR(found, expected, 0.05 * expected) << "slope " << slope;
  }
}

}  // namespace
}  // namespace soft_tissue::test
