#include <gtest/gtest.h>

#include <cstdio>

#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kRadius = 0.02;

// Penalty contact at full depth would throw these apart at metres per second.
TEST(DeepStart, FreeBallsComeApartTheShortWayWithoutABurst)
{
  for (const Response response : {Response::point, Response::segment})
  {
    for (const double overlap : {0.1, 0.5, 0.9})
    {
      const ScratchFolder folder;
      const std::string file = saved(folder, "ball.msh", makeBall(kRadius, 1500));
      SceneConfig config = tissueScene(file);
      config.tissues[0].material.young_modulus_pa = 2e4;
      addTissue(config, "other", file, Vec3(0.0, 0.0, (2.0 - overlap) * kRadius));
      addPair(config, "tissue", "other", response);
      Scene scene(config);
      Snapshot state;
      double fastest = 0.0, deepest = 0.0, least_det = 1.0;
      int held = 0;
      for (int k = 0; k < 400; ++k)
      {
        held += scene.step().held ? 1 : 0;
        scene.fillSnapshot(state);
        fastest = std::max(fastest, rmsSpeed(state));
        least_det = std::min(least_det, state.report.min_det_f);
        deepest = state.report.max_penetration_m;
      }
      const Vec3 apart = centreOf(state.tissues[1]) - centreOf(state.tissues[0]);
      std::printf(
          "  %s, %.1f R: at most %.1f mm/s, least det F %.2f, %d held; %.2f R apart after 4 s, "
          "%.4f mm deep\n",
          response == Response::point ? "points" : "segments", overlap, 1e3 * fastest, least_det,
          held, apart.norm() / kRadius, 1e3 * deepest);
      EXPECT_LT(fastest, 2.0 * kRadius);  // per second: a radius a second is what they are let
      EXPECT_EQ(held, 0);
      EXPECT_GT(apart.norm(), 1.99 * kRadius);
      EXPECT_LT(apart.head<2>().norm(), 0.15 * apart.z());
      EXPECT_GT(least_det, 0.2);
    }
  }
}

TEST(DeepStart, StartsTheSameAfterAReset)
{
  const ScratchFolder folder;
  const std::string file = saved(folder, "ball.msh", makeBall(kRadius, 1000));
  SceneConfig config = tissueScene(file);
  addTissue(config, "other", file, Vec3(0.0, 0.0, 1.6 * kRadius));
  addPair(config, "tissue", "other", Response::segment);
  Scene scene(config);
  Snapshot first, again;
  const auto run = [&](Snapshot& state) {
    for (int k = 0; k < 20; ++k)
    {
      scene.step();
    }
    scene.fillSnapshot(state);
  };
  run(first);
  scene.resetWorld();
  run(again);
  EXPECT_EQ(first.tissues[1].positions, again.tissues[1].positions);
}

}  // namespace
}  // namespace soft_tissue::test
