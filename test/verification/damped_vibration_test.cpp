#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "support/finite_difference.h"
#include "support/small_scenes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** A block of 2 x 2 x 2 cells whose surface is held: one node in the middle is all that moves. */
class DampedVibration : public ::testing::Test
{
 protected:
  DampedVibration() : config_(blockScene(folder_, {2, 2, 2}))
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double ends[3][2] = {{-0.03, 0.03}, {-0.03, 0.03}, {0.0, kBlockTop}};
      for (const double end : ends[axis])
      {
        Vec3 low = Vec3::Constant(-1.0), high = Vec3::Constant(1.0);
        low[axis] = end - 1e-6;
        high[axis] = end + 1e-6;
        config_.tissues[0].fixed.push_back({low, high});
      }
    }
    const Scene scene(config_);
    const TissueInfo& info = scene.tissues()[0];
    const MaterialConfig& material = config_.tissues[0].material;
    const TetMesh& rest = info.rest;
    TetElasticity elasticity(
        rest, material.model,
        std::vector<TetStiffnessParameters>(rest.tets.size(),
                                            {material.young_modulus_pa, material.poisson_ratio}),
        0);
    const auto count = static_cast<Index>(rest.nodes.size());
    const Eigen::MatrixXd stiffness =
        hessianOf(elasticity, rest.nodes, nodeNeighbours(count, rest.tets), Curvature::exact);
    std::vector<double> masses(count, 0.0);
    addLumpedMasses(rest, std::vector<double>(rest.tets.size(), material.density_kg_per_m3), 0,
                    masses);
    while (info.surface.node_slot[node_] >= 0)
    {
      ++node_;
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> modes(
        Mat3(stiffness.block<3, 3>(3 * node_, 3 * node_)));
    mode_ = modes.eigenvectors().col(0);
    frequency_ = std::sqrt(modes.eigenvalues()[0] / masses[node_]);
  }

  /** How far the node is along its mode after each of so many steps, m. */
  std::vector<double> vibrate(double mass_damping, double stiffness_damping, int steps)
  {
    config_.time_step_s = kStep / frequency_;
    config_.solver.tolerance = 1e-10;
    config_.tissues[0].velocity_m_per_s = 1e-6 * frequency_ * mode_;  // some micrometres
    config_.tissues[0].material.mass_damping_per_s = mass_damping;
    config_.tissues[0].material.stiffness_damping_s = stiffness_damping;
    Scene scene(config_);
    Snapshot snapshot;
    std::vector<double> way = {0.0};
    for (int k = 0; k < steps; ++k)
    {
      EXPECT_TRUE(scene.step().converged);
      scene.fillSnapshot(snapshot);
      way.push_back(
          mode_.dot(snapshot.tissues[0].positions[node_] - scene.tissues()[0].rest.nodes[node_]));
    }
    return way;
  }

  static constexpr double kStep = 0.01;  // times the frequency
  static constexpr int kPeriod = 628;    // steps
  ScratchFolder folder_;
  SceneConfig config_;
  Index node_ = 0;
  Vec3 mode_;
  double frequency_ = 0.0;  ///< rad/s
};

TEST_F(DampedVibration, DecaysAsRayleighSays)
{
  const double w = frequency_, h = kStep / w;
  for (const auto& [by_mass, by_stiffness] :
       std::vector<std::pair<double, double>>{{0.0, 0.0}, {0.1, 0.0}, {0.0, 0.1}, {0.06, 0.04}})
  {
    const double alpha = by_mass * w, beta = by_stiffness / w;
    const std::vector<double> way = vibrate(alpha, beta, kPeriod);
    // Implicit Euler, to rounding: x'' + c x' + w^2 x = 0 with c = alpha + beta w^2.
    const double c = alpha + beta * w * w;
    double most = 0.0;
    for (int k = 1; k < kPeriod; ++k)
    {
      const double off =
          (1.0 + c * h + w * w * h * h) * way[k + 1] - (2.0 + c * h) * way[k] + way[k - 1];
      most = std::max(most, std::abs(off));
    }
    EXPECT_LT(most, 1e-5 * 1e-6 * kStep);
    // Amplitudes a period apart. The method's own damping is w h / 2.
    const auto energy = [&](int k) {
      const double speed = (way[k + 1] - way[k]) / (w * h);
      return speed * speed + way[k] * way[k];
    };
    const double measured =
        -0.5 * std::log(energy(kPeriod - 1) / energy(0)) / (w * h * (kPeriod - 1));
    const double ratio = alpha / (2.0 * w) + 0.5 * beta * w;
    std::printf(
        "  damping ratio %.5f, of which the method's %.5f; alpha / 2w + beta w / 2 = %.5f\n",
        measured, 0.5 * kStep, ratio);
    EXPECT_NEAR(measured - 0.5 * kStep, ratio, 0.02 * ratio + 1e-4);
  }
}

/** Kinetic energy and that of springs never rise, and fall faster with damping. */
TEST_F(DampedVibration, TakesEnergyAndGivesNone)
{
  double left = 1e300;  // after a period
  for (const double share : {0.0, 0.05, 0.5, 5.0})
  {
    const std::vector<double> way = vibrate(0.0, share / frequency_, kPeriod);
    double before = 1e300;
    for (int k = 0; k < kPeriod; ++k)
    {
      const double speed = (way[k + 1] - way[k]) / kStep;
      const double energy = speed * speed + way[k + 1] * way[k + 1];
      EXPECT_LE(energy, before * (1.0 + 1e-9));
      before = energy;
    }
    EXPECT_LT(before, left);
    left = before;
  }
}

}  // namespace
}  // namespace soft_tissue
