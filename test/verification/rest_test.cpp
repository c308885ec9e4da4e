#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "support/tissue_scenes.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kGravity = 9.81;
constexpr double kStill = 1e-5;  // m/s

class AtRest : public testing::TestWithParam<Response>
{
 protected:
  /** The time after which a scene's nodes never moved faster than kStill, in so many steps of 10
   * ms, s. */
  static double restsAfter(Scene& scene, int steps)
  {
    Snapshot snapshot;
    double moved = 0.0;
    for (int k = 0; k < steps; ++k)
    {
      EXPECT_FALSE(scene.step().held) << k;
      scene.fillSnapshot(snapshot);
      const double speed = rmsSpeed(snapshot);
      if (!(speed < kStill))
      {
        moved = scene.time();
      }
    }
    std::printf("  still after %.2f s, %.1e m/s after %.0f s; deepest %.3f mm\n", moved,
                rmsSpeed(snapshot), scene.time(), 1e3 * snapshot.report.max_penetration_m);
    return moved;
  }

  ScratchFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Responses, AtRest, testing::Values(Response::point, Response::segment));

TEST_P(AtRest, AStackOfFiveBlocks)
{
  const std::string block = saved(folder_, "block.msh", makeBox({3, 3, 2}, {0.04, 0.04, 0.02}));
  SceneConfig config = tissueScene(block);
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -kGravity);
  config.solver.tolerance = 1e-6;  // what it leaves must not pass for motion
  config.tissues[0].material.young_modulus_pa = 2e4;
  fixBelow(config, 1e-6);
  const char* names[] = {"tissue", "second", "third", "fourth", "fifth"};
  for (int k = 1; k < 5; ++k)
  {
    addTissue(config, names[k], block, {0.001 * k, -0.0015 * (k % 2), 0.0205 * k});
    addPair(config, names[k - 1], names[k], GetParam()).friction = 0.4;
  }
  Scene scene(config);
  EXPECT_LT(restsAfter(scene, 2000), 9.0);
}

/** A bowl standing on z = 0, open upwards: rings of the inside, the rim, rings of the outside. */
TriMesh bowl(double inner, double outer, int around, int rings)
{
  TriMesh mesh;
  const auto addRings = [&](double radius, bool down) {
    for (int i = 0; i < rings; ++i)
    {
      const double angle = 0.5 * M_PI * (down ? rings - i : i + 1) / rings;
      for (int k = 0; k < around; ++k)
      {
        const double turn = 2.0 * M_PI * k / around;
        mesh.nodes.push_back({radius * std::sin(angle) * std::cos(turn),
                              radius * std::sin(angle) * std::sin(turn),
                              outer - radius * std::cos(angle)});
      }
    }
  };
  mesh.nodes.push_back({0.0, 0.0, outer - inner});
  addRings(inner, false);
  addRings(outer, true);
  mesh.nodes.push_back({0.0, 0.0, 0.0});
  const auto last = static_cast<Index>(mesh.nodes.size()) - 1;
  const auto at = [&](int ring, int k) { return 1 + ring * around + k % around; };
  for (int k = 0; k < around; ++k)
  {
    mesh.triangles.push_back({0, at(0, k), at(0, k + 1)});
    for (int ring = 0; ring + 1 < 2 * rings; ++ring)
    {
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1)});
      mesh.triangles.push_back({at(ring, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
    mesh.triangles.push_back({last, at(2 * rings - 1, k + 1), at(2 * rings - 1, k)});
  }
  return mesh;
}

TEST_P(AtRest, AnOrganInABowl)
{
  SceneConfig config = lobeScene();
  config.gravity_m_per_s2 = Vec3(0.0, 0.0, -kGravity);
  config.solver.tolerance = 1e-5;
  MeshShape shape;
  shape.mesh.file = folder_.path("bowl.stl");
  saveStl(shape.mesh.file, bowl(0.07, 0.08, 48, 12));
  PoseConfig pose;
  pose.position_m = Vec3(0.003, -0.002, -0.06);
  addTool(config, shape, pose, GetParam());
  config.contacts[0].friction = 0.3;
  config.contacts[0].stiffness_pa_per_m.reset();
  Scene scene(config);
  EXPECT_LT(restsAfter(scene, 1200), 2.0);
}
}  // namespace
}  // namespace soft_tissue::test
