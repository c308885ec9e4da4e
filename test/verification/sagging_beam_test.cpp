#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue
{
namespace
{
/** Displacement of a beam's tip, mm. */
struct Tip
{
  double x = 0.0;
  double y = 0.0;
};

/**
 * A beam of 100 x 20 x 20 mm that sags from its clamped end at x = 0. Its tip is the mean of the
 * four corners at the other end; references come from another program with the same meshes and the
 * same corotated energy, Newton's method to 1e-8.
 */
class SaggingBeam : public ::testing::Test
{
 protected:
  void SetUp() override
  {
    const char* data = std::getenv("SOFT_TISSUE_DATA");
    if (data == nullptr)
    {
      GTEST_SKIP() << "SOFT_TISSUE_DATA is not set";
    }
    folder_ = data;
  }

  SceneConfig scene(const std::string& mesh, MaterialModel model, double gravity) const
  {
    SceneConfig config;
    config.file = "sagging beam";
    config.time_step_s = 0.01;
    config.gravity_m_per_s2 = Vec3(0.0, -gravity, 0.0);
    config.solver.tolerance = 1e-8;
    config.solver.max_iterations = 200;
    TissueConfig tissue;
    tissue.name = "beam";
    tissue.mesh.file = folder_ + "/beams/" + mesh + ".msh";
    tissue.material = {model, 5000.0, 0.45, 1000.0};
    tissue.fixed.push_back({Vec3(-1e-9, -1.0, -1.0), Vec3(1e-9, 1.0, 1.0)});
    config.tissues.push_back(tissue);
    return config;
  }

  static Tip tip(const Scene& scene)
  {
    Snapshot snapshot;
    scene.fillSnapshot(snapshot);
    const Points& rest = scene.tissues()[0].rest.nodes;
    Vec3 low = rest[0], high = rest[0];
    for (const Vec3& p : rest)
    {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    Vec3 sum = Vec3::Zero();
    int corners = 0;
    for (std::size_t i = 0; i < rest.size(); ++i)
    {
      const Vec3 to_low = (rest[i] - low).cwiseAbs(), to_high = (high - rest[i]).cwiseAbs();
      if (to_high.x() < 1e-9 && to_low.cwiseMin(to_high).tail<2>().maxCoeff() < 1e-9)
      {
        sum += snapshot.tissues[0].positions[i] - rest[i];
        ++corners;
      }
    }
    EXPECT_EQ(corners, 4);
    return {1e3 * sum.x() / corners, 1e3 * sum.y() / corners};
  }

  std::string folder_;
};

struct Reference
{
  const char* mesh;
  double gravity;
  Tip tip;
};

void compare(const char* what, const Reference& row, const Tip& found, double tolerance_mm)
{
  std::printf("  %s, %s, g %.3f m/s^2: tip (%.2f, %.2f) mm, reference (%.2f, %.2f) mm\n", what,
              row.mesh, row.gravity, found.x, found.y, row.tip.x, row.tip.y);
  EXPECT_NEAR(found.x, row.tip.x, tolerance_mm) << row.mesh;
  EXPECT_NEAR(found.y, row.tip.y, tolerance_mm) << row.mesh;
}

TEST_F(SaggingBeam, HangsAsDeepAsInAnotherProgram)
{
  const Reference linear[] = {{"beam1k", 0.981, {-10.86, -43.43}},
                              {"beam5k", 0.981, {-14.81, -50.10}},
                              {"beam20k", 0.981, {-17.15, -53.56}},
                              {"beam1k", 9.81, {-74.40, -102.57}},
                              {"beam5k", 9.81, {-80.12, -104.62}}};
  const Reference quadratic[] = {{"beam1k", 0.981, {-18.81, -55.79}},
                                 {"beam5k", 0.981, {-19.09, -56.24}},
                                 {"beam1k", 9.81, {-82.13, -105.17}}};
  for (const ElementKind element : {ElementKind::tet4, ElementKind::tet10})
  {
    const bool is_linear = element == ElementKind::tet4;
    for (const Reference& row :
         is_linear ? std::vector<Reference>(std::begin(linear), std::end(linear))
                   : std::vector<Reference>(std::begin(quadratic), std::end(quadratic)))
    {
      SceneConfig config = scene(row.mesh, MaterialModel::corotated, row.gravity);
      config.solver.stepper = Stepper::quasi_static;
      config.tissues[0].element = element;
      Scene beam(config);
      ASSERT_TRUE(beam.step().converged) << row.mesh;
      compare(is_linear ? "static tet4" : "static tet10", row, tip(beam), 0.01);  // its digits
    }
  }
}

// The limit of that program's quadratic tets: 59.4 mm of way, of which coarse linear ones miss a
// quarter.
TEST_F(SaggingBeam, HangsAsDeepAsItShouldWithAFewQuadraticTets)
{
  const Vec3 limit(-19.09, -56.24, 0.0);
  for (const MaterialModel model : {MaterialModel::corotated, MaterialModel::neo_hookean})
  {
    for (const char* mesh : {"beam1k", "beam5k"})
    {
      SceneConfig config = scene(mesh, model, 0.981);
      config.solver.stepper = Stepper::quasi_static;
      config.tissues[0].element = ElementKind::tet10;
      Scene beam(config);
      ASSERT_TRUE(beam.step().converged) << mesh;
      const Tip found = tip(beam);
      std::printf("  %s, %zu nodes: tip (%.2f, %.2f) mm\n", mesh,
                  beam.tissues()[0].rest.nodes.size(), found.x, found.y);
      if (model == MaterialModel::corotated)
      {
        EXPECT_LT((Vec3(found.x, found.y, 0.0) - limit).norm(), 0.01 * limit.norm()) << mesh;
      }
    }
  }
}

TEST_F(SaggingBeam, SwingsAsInAnotherProgram)
{
  const Reference rows[] = {{"beam5k", 0.981, {-12.62, -47.23}},
                            {"beam5k", 9.81, {-96.19, -106.15}}};
  for (const Reference& row : rows)
  {
    Scene beam(scene(row.mesh, MaterialModel::corotated, row.gravity));
    for (int n = 0; n < 200; ++n)
    {
      ASSERT_TRUE(beam.step().converged) << "step " << n;
    }
    compare("after 2 s", row, tip(beam), 0.05);  // what 200 steps to 1e-8 add up to
  }
}

}  // namespace
}  // namespace soft_tissue
