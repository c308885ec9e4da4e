#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kLength = 0.4, kRadius = 0.01;

/** A tube lying along x whose head is driven to beyond its tail, a little sideways on the way. */
SceneConfig snake(const ScratchFolder& folder, std::size_t tets, bool touches_itself)
{
  SceneConfig config =
      tissueScene(saved(folder, "tube.msh", makeTube(0.4 * kRadius, kRadius, kLength, tets)));
  TissueConfig& tube = config.tissues[0];
  tube.pose.rotation_rpy_rad = Vec3(0.0, M_PI / 2, 0.0);
  tube.material.young_modulus_pa = 2e4;
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, 0.0);
  tube.fixed = {{Vec3(-1.0, -1.0, -1.0), Vec3(0.01, 1.0, 1.0)}};
  NodeMotionConfig head;
  head.nodes = {Vec3(kLength - 0.01, -1.0, -1.0), Vec3(1.0, 1.0, 1.0)};
  const auto at = [&](double time, double x, double y, double z, double yaw) {
    PoseKeyframe frame;
    frame.time_s = time;
    frame.pose.position_m = Vec3(x, y, z);
    frame.pose.rotation_rpy_rad = Vec3(0, 0, yaw);
    head.motion.push_back(frame);
  };
  at(0.0, kLength, 0.0, 0.0, 0.0);
  at(0.4, 0.8 * kLength, 0.03, 0.0, 0.0);
  at(2.0, -0.4 * kLength, 0.0, 0.0, 0.0);
  tube.keyframes = {head};
  if (touches_itself)
  {
    addPair(config, "tissue", "tissue", Response::segment);
  }
  return config;
}

TEST(Snake, X)
{
  const ScratchFolder folder;
  for (const bool touches : {false, true})
  {
    Scene scene(snake(folder, getenv("TETS") ? atoi(getenv("TETS")) : 4000, touches));
    std::printf("%zu tets\n", scene.tissues()[0].rest.tets.size());
    Snapshot snapshot;
    StageTimes ms;
    for (int k = 0; k < 200; ++k)
    {
      const StepReport& r = scene.step();
      ms.fem += r.ms.fem; ms.field += r.ms.field; ms.detect += r.ms.detect; ms.respond += r.ms.respond; ms.solve += r.ms.solve; ms.total += r.ms.total;
      if (k % 10 == 9)
      std::printf("  %d: newton %d res %.1e halv %d parts %d held %d detF %.2f contacts %d deepest %.2f mm, %.0f ms\n", k, r.newton_iterations, r.residual, r.halvings, r.parts, r.held, r.min_det_f,
                  r.contacts, 1e3 * r.max_penetration_m, r.ms.total);
    }
    std::printf("  fem %.0f field %.0f detect %.0f respond %.0f solve %.0f total %.0f\n", ms.fem, ms.field, ms.detect, ms.respond, ms.solve, ms.total);
    scene.fillSnapshot(snapshot);
    TetMesh mesh = scene.tissues()[0].rest;
    mesh.nodes = snapshot.tissues[0].positions;
    saveGmsh(touches ? "/tmp/snake_on.msh" : "/tmp/snake_off.msh", mesh);
  }
}
}  // namespace
}  // namespace soft_tissue::test
