#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
/** A block that a ball presses down and strokes, from step to step. */
inline SceneConfig stroked(const ScratchFolder& folder)
{
  SceneConfig config = blockScene(folder, {5, 5, 3});
  fixBelow(config, 1e-6);
  addTool(config, SphereShape{0.01}, {}, Response::segment);
  config.contacts[0].friction = 0.5;
  config.tools[0].pose_source.kind = PoseSourceConfig::Kind::keyframes;
  config.tools[0].pose_source.keyframes = {
      {0.0, {Vec3(0.0, 0.0, kBlockTop + 0.0101), Vec3::Zero()}},
      {0.1, {Vec3(0.0, 0.0, kBlockTop + 0.007), Vec3::Zero()}},
      {0.4, {Vec3(0.008, 0.003, kBlockTop + 0.006), Vec3::Zero()}}};
  return config;
}

inline void expectSame(const std::vector<ContactPoint>& a, const std::vector<ContactPoint>& b)
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

inline void expectSame(const Scene& one, const Scene& other)
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

}  // namespace soft_tissue::test
