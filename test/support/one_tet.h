#pragma once

#include <cmath>

#include "support/small_scenes.h"

namespace soft_tissue::test
{
/**
 * A tet whose base is fixed, its tip above it: a mass that small motions along x, y and z see held
 * by a spring each, as F is I + u (0, 0, 1 / height).
 */
struct OneTet
{
  static constexpr double kHeight = 0.01;     // m
  static constexpr double kYoung = 1e4;       // Pa
  static constexpr double kPoisson = 0.25;    // so lambda = mu = 0.4 E
  static constexpr double kDensity = 1000.0;  // kg/m^3
  static constexpr int kTip = 3;

  /** Radians a second of the motion up and down, which sees lambda + 2 mu. */
  static double upAndDown() { return std::sqrt(3.0 * 0.4 * kYoung / (0.25 * kDensity)) / kHeight; }
  /** And sidewards, which sees mu. */
  static double sidewards() { return std::sqrt(0.4 * kYoung / (0.25 * kDensity)) / kHeight; }

  /** A scene without gravity in which the tip starts with this velocity, m/s. */
  static SceneConfig scene(const ScratchFolder& folder, const Vec3& velocity)
  {
    TetMesh tet;
    tet.nodes = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0.002, 0.003, kHeight}};
    tet.tets = {{0, 1, 2, 3}};
    tet.tags = {0};
    const std::string file = folder.path("tet.msh");
    saveGmsh(file, tet);
    SceneConfig config = tissueScene(file);
    config.tissues[0].material = {MaterialModel::neo_hookean, kYoung, kPoisson, kDensity};
    config.tissues[0].velocity_m_per_s = velocity;
    config.solver.tolerance = 1e-10;
    config.solver.linear = LinearSolverKind::cholesky;
    fixBelow(config, 1e-6);
    return config;
  }
};

}  // namespace soft_tissue::test
