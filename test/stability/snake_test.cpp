#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "soft_tissue_sim/contact/tissue_contact.h"
#include "soft_tissue_sim/scene/tissue_field.h"
#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kLength = 0.4, kRadius = 0.01;

/** A tube along x whose tail is held while its head is driven towards it and turned round. */
SceneConfig snake(const ScratchFolder& folder, std::size_t tets, bool touches_itself)
{
  SceneConfig config =
      tissueScene(saved(folder, "tube.msh", makeTube(0.4 * kRadius, kRadius, kLength, tets)));
  config.gravity_m_per_s2.setZero();
  TissueConfig& tube = config.tissues[0];
  tube.pose.rotation_rpy_rad = Vec3(0.0, M_PI / 2, 0.0);
  tube.material.young_modulus_pa = 2e4;
  tube.fixed = {{Vec3(-1.0, -1.0, -1.0), Vec3(0.01, 1.0, 1.0)}};
  NodeMotionConfig head;
  head.nodes = {Vec3(kLength - 0.01, -1.0, -1.0), Vec3(1.0, 1.0, 1.0)};
  constexpr int kFrames = 24;
  constexpr double kTurns = 3.0, kDuration = 2.4;
  for (int k = 0; k <= kFrames; ++k)
  {
    const double part = static_cast<double>(k) / kFrames;
    PoseKeyframe frame;
    frame.time_s = kDuration * part;
    frame.pose.position_m = Vec3((1.0 - 0.6 * part) * kLength, 0.01 * part, 0.0);
    frame.pose.rotation_rpy_rad =
        Vec3(std::remainder(2.0 * M_PI * kTurns * part, 2.0 * M_PI), 0, 0);
    head.motion.push_back(frame);
  }
  tube.keyframes = {head};
  if (touches_itself)
  {
    addPair(config, "tissue", "tissue", Response::segment);
  }
  return config;
}

/** How deep a snake is in itself at most while it is driven, by a contact of its own, m. */
double deepestOf(std::size_t tets, bool touches_itself)
{
  const ScratchFolder folder;
  Scene scene(snake(folder, tets, touches_itself));
  const TissueInfo& info = scene.tissues()[0];
  const auto count = static_cast<Index>(info.rest.nodes.size());
  const Adjacency neighbours = nodeNeighbours(count, info.rest.tets);
  const TissueBody body = {&info.rest.tets, &info.surface, 0, count, 0.002, &info.rest.nodes};
  TissueContact probe({body, makeDistanceField(FieldConfig(), {&info.surface, &neighbours})},
                      ContactOptions());
  Snapshot snapshot;
  double deepest = 0.0;
  int held = 0;
  for (int k = 0; k < 260; ++k)
  {
    held += scene.step().held ? 1 : 0;
    scene.fillSnapshot(snapshot);
    const Points& x = snapshot.tissues[0].positions;
    probe.beginStep(x, x, true);
    deepest = std::max(deepest, probe.active() ? probe.deepest(x) : 0.0);
  }
  std::printf("  %zu tets, %s: at most %.2f mm deep in itself, %d of 260 steps held\n",
              info.rest.tets.size(), touches_itself ? "touching itself" : "not touching itself",
              1e3 * deepest, held);
  EXPECT_LE(held, 3);
  return deepest;
}

// The tube is 20 mm thick, its wall 6 mm.
constexpr double kShallow = 0.001, kThrough = 0.002;

TEST(Snake, CoilsUpWhereItTouchesItselfAndElseGoesThroughItself)
{
  EXPECT_LT(deepestOf(3000, true), kShallow);
  EXPECT_GT(deepestOf(3000, false), kThrough);
}

// A minute: asked for by --gtest_also_run_disabled_tests.
TEST(Snake, DISABLED_CoilsUpAsATubeOf14000Tets)
{
  EXPECT_LT(deepestOf(14000, true), kShallow);
  EXPECT_GT(deepestOf(14000, false), kThrough);
}
}  // namespace
}  // namespace soft_tissue::test
