#include "soft_tissue_sim/contact/tool_surface.h"

#include <gtest/gtest.h>

#include <numeric>

#include "support/contact_scene.h"

namespace soft_tissue::test
{
namespace
{
double sum(const std::vector<double>& values)
{
  return std::accumulate(values.begin(), values.end(), 0.0);
}
}  // namespace

TEST(ToolSurface, SharesOutTheWholeArea)
{
  const double pi = 3.14159265358979323846;
  const std::vector<std::pair<std::shared_ptr<const RigidShape>, double>> cases = {
      {makeSphere(0.004), 4 * pi * 0.004 * 0.004},
      {makeCapsule(0.004, 0.02), 4 * pi * 0.004 * 0.004 + 2 * pi * 0.004 * 0.02},
      {makeBox({0.006, 0.005, 0.01}), 2 * (0.006 * 0.005 + 0.006 * 0.01 + 0.005 * 0.01)}};
  for (const auto& [shape, area] : cases)
  {
    RigidBodyShape tool;
    tool.add(shape, Pose::Identity());
    const ToolSurface surface = sampleToolSurface(tool);
    EXPECT_GE(surface.nodes.size(), 100u);
    EXPECT_LE(surface.nodes.size(), 2000u);
    EXPECT_NEAR(sum(surface.node_area), area, 0.05 * area);
    EXPECT_NEAR(sum(surface.edge_area), sum(surface.node_area), 1e-12 * area);
  }
}

TEST(ToolSurface, CoarsensALongShaft)
{
  RigidBodyShape tool;
  tool.add(makeCapsule(0.004, 0.4), Pose::Identity());
  EXPECT_LE(sampleToolSurface(tool).nodes.size(), 2000u);
}

TEST(ToolSurface, LeavesOutWhatAnotherPartHides)
{
  RigidBodyShape tool;
  tool.add(makeSphere(0.004), Pose::Identity());
  tool.add(makeSphere(0.004), at({0.004, 0, 0}));
  const ToolSurface surface = sampleToolSurface(tool);
  for (std::size_t i = 0; i < surface.nodes.size(); ++i)
  {
    EXPECT_TRUE(surface.node_area[i] == 0.0 || tool.distance(surface.nodes[i]).distance > -1e-8);
  }
  const double pi = 3.14159265358979323846;
  const double outside = 2 * 3 * pi * 0.004 * 0.004;  // two balls less a cap of half a radius each
  EXPECT_NEAR(sum(surface.node_area), outside, 0.1 * outside);
}

}  // namespace soft_tissue::test
