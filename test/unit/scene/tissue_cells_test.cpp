#include "soft_tissue_sim/scene/tissue_cells.h"

#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/scene/octomap_data.h"
#include "support/tissue_scenes.h"
#include "support/voxel_samples.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kCell = 0.005;

SceneConfig withCells(SceneConfig config, double resolution = kCell)
{
  config.outputs.octomap = OctomapOutputConfig();
  config.outputs.octomap->resolution_m = resolution;
  return config;
}

Snapshot snapshotOf(const Scene& scene)
{
  Snapshot snapshot;
  scene.fillSnapshot(snapshot);
  return snapshot;
}

TEST(TissueCells, OfABlockAreItsCells)
{
  const ScratchFolder folder;
  const SceneConfig config = withCells(blockScene(folder, {4, 4, 2}));
  const Scene scene(config);
  TissueCells cells(config, scene.tissues());
  EXPECT_TRUE(cells.occupied().bounds().empty());
  cells.update(snapshotOf(scene));
  VoxelSet block(kCell);
  block.fill({Cell(-6, -6, 0), Cell(6, 6, 6)}, true);
  EXPECT_EQ(cells.occupied().contents(), block.contents());
}

// Deformed as it pleases: each point of it is in an occupied cell, and each occupied cell near it.
TEST(TissueCells, HoldAllOfADeformedTissueAndNoMore)
{
  SceneConfig config = withCells(lobeScene(), 0.003);
  Scene scene(config);
  const TissueInfo& info = scene.tissues()[0];
  Points x = info.rest.nodes;
  for (Vec3& p : x)
  {
    p += Vec3(0.3 * p.z(), 0.004 * std::sin(80.0 * p.x()), 0.2 * p.y());
  }
  scene.setMotion(0, x, Points(x.size(), Vec3::Zero()));
  TissueCells cells(config, scene.tissues());
  cells.update(snapshotOf(scene));
  RandomGeometry random(3);
  for (int trial = 0; trial < 20000; ++trial)
  {
    const Tet& tet = info.rest.tets[trial % info.rest.tets.size()];
    Eigen::Vector4d weights;
    for (int k = 0; k < 4; ++k)
    {
      weights[k] = -std::log(random.uniform(1e-9, 1.0));
    }
    weights /= weights.sum();
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < 4; ++k)
    {
      p += weights[k] * x[tet[k]];
    }
    EXPECT_TRUE(cells.occupied().occupied(cells.occupied().cellOf(p)));
  }
  const SurfaceMesh surface = {x, info.surface.triangles};
  cells.occupied().forEachOther([&](const Cell& cell) {
    const Vec3 middle = 0.003 * (cell.cast<double>() + Vec3::Constant(0.5));
    const double distance = bruteForceDistance(middle, surface.nodes, surface.triangles);
    EXPECT_TRUE(windingNumber(middle, surface) > 0.5 || distance < 0.5 * std::sqrt(3.0) * 0.003);
  });
}

TEST(TissueCells, RememberWhatTheTissueLeft)
{
  const ScratchFolder folder;
  const SceneConfig config = withCells(blockScene(folder, {2, 2, 1}));
  Scene scene(config);
  TissueCells cells(config, scene.tissues());
  cells.update(snapshotOf(scene));
  const std::uint64_t before = cells.occupied().contents();
  Points x = scene.tissues()[0].rest.nodes;
  for (Vec3& p : x)
  {
    p.z() += 10.0 * kCell;
  }
  scene.setMotion(0, x, Points(x.size(), Vec3::Zero()));
  cells.update(snapshotOf(scene));
  EXPECT_NE(cells.occupied().contents(), before);
  EXPECT_FALSE(cells.occupied().occupied({0, 0, 0}));
  EXPECT_TRUE(cells.seen().occupied({0, 0, 0}));
  EXPECT_TRUE(cells.occupied().occupied({0, 0, 12}));
}

// A scene that takes its own tissue for an obstacle has the cells it gave out.
TEST(TissueCells, ComeBackAsAnObstacle)
{
  SceneConfig config = withCells(lobeScene());
  ObstacleConfig obstacle;
  obstacle.name = "map";
  obstacle.octomap.topic = "octomap_in";
  obstacle.octomap.resolution_m = kCell;
  config.obstacles.push_back(obstacle);
  Scene scene(config);
  TissueCells cells(config, scene.tissues());
  cells.update(snapshotOf(scene));
  for (const bool binary : {false, true})
  {
    scene.setObstacleCells(
        0, octomapCells(octomapOf(cells.occupied(), cells.seen(), binary), obstacle.octomap));
    const VoxelSet back = scene.setObstacleCells(0, VoxelSet(kCell));
    EXPECT_EQ(back.contents(), cells.occupied().contents());
  }
}

TEST(TissueCells, RefusesTooManyCells)
{
  const ScratchFolder folder;
  const SceneConfig config = withCells(blockScene(folder, {2, 2, 1}), 0.0001);
  const Scene scene(config);
  try
  {
    TissueCells cells(config, scene.tissues());
    FAIL();
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(),
                 "scene small scene: outputs.octomap.resolution_m = 0.0001: boxes around the "
                 "tissues have 1.08e+08 such cells, must be at most 1.67772e+07");
  }
}

}  // namespace
}  // namespace soft_tissue::test
