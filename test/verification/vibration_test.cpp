#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "support/small_scenes.h"
#include "support/timoshenko.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kLength = 0.1, kThick = 0.02;  // m
constexpr double kYoung = 1e4;                  // Pa
constexpr double kDensity = 1000.0;             // kg/m^3
constexpr double kAxial = 7.90569;              // Hz, a rod
constexpr double kBending = 1.02167;            // Hz, Euler and Bernoulli
constexpr int kSteps = 120;                     // a period

TEST(TimoshenkoCantilever, IsEulersBeamWithoutShearAndRotaryInertia)
{
  EXPECT_NEAR(TimoshenkoCantilever(0.0, 0.0).firstFrequency(), 3.51602, 1e-5);
}

// Rayleigh's quotient with Euler's mode is an upper bound; its first order is exact for small
// corrections: 1 - w^2 lowers by r |w'|^2 / |w|^2 and s |w'''|^2 / |w''|^2.
TEST(TimoshenkoCantilever, IsLoweredByBothToFirstOrder)
{
  const double k = 1.8751040687, mix = 0.7340955137;
  double w = 0.0, slope = 0.0, bend = 0.0, shear = 0.0;
  for (int i = 0; i < 2000; ++i)
  {
    const double z = k * (i + 0.5) / 2000.0;
    w += std::pow(std::cosh(z) - std::cos(z) - mix * (std::sinh(z) - std::sin(z)), 2);
    slope += k * k * std::pow(std::sinh(z) + std::sin(z) - mix * (std::cosh(z) - std::cos(z)), 2);
    bend += std::pow(k, 4) *
            std::pow(std::cosh(z) + std::cos(z) - mix * (std::sinh(z) + std::sin(z)), 2);
    shear += std::pow(k, 6) *
             std::pow(std::sinh(z) - std::sin(z) - mix * (std::cosh(z) + std::cos(z)), 2);
  }
  constexpr double kSmall = 1e-5;
  const double euler = TimoshenkoCantilever(0.0, 0.0).firstFrequency();
  const auto lowered = [&](double rotary, double by_shear) {
    return 1.0 - TimoshenkoCantilever(rotary, by_shear).firstFrequency() / euler;
  };
  EXPECT_NEAR(lowered(kSmall, 0.0), 0.5 * kSmall * slope / w, 1e-2 * kSmall * slope / w);
  EXPECT_NEAR(lowered(0.0, kSmall), 0.5 * kSmall * shear / bend, 1e-2 * kSmall * shear / bend);
}

enum class Mode
{
  axial,
  bending,
};

/** A square bar clamped at x = 0, nu = 0, set off with a uniform small velocity. */
class Vibration : public testing::Test
{
 protected:
  static double shapeAt(Mode mode, double x)
  {
    if (mode == Mode::axial)
    {
      return std::sin(0.5 * M_PI * x / kLength);
    }
    const double z = 1.8751040687 * x / kLength;
    return std::cosh(z) - std::cos(z) - 0.7340955137 * (std::sinh(z) - std::sin(z));
  }

  /** Frequency of the bar of n cells over its thickness, from how the part of the motion that has
   * the mode's shape passes through zero; BDF2's own error is taken off. Hz */
  double frequencyOf(Mode mode, ElementKind element, int cells) const
  {
    const double expected = mode == Mode::axial ? kAxial : kBending;
    const int axis = mode == Mode::axial ? 0 : 2;
    const std::string file = folder_.path("bar.msh");
    saveGmsh(file, makeBox({5 * cells, cells, cells}, {kLength, kThick, kThick}));
    SceneConfig config = tissueScene(file);
    config.time_step_s = 1.0 / (kSteps * expected);
    config.solver.stepper = Stepper::bdf2;
    config.solver.tolerance = 1e-6;
    TissueConfig& tissue = config.tissues[0];
    tissue.element = element;
    tissue.material = {MaterialModel::neo_hookean, kYoung, 0.0, kDensity};
    tissue.velocity_m_per_s = 1e-4 * Vec3::Unit(axis);
    tissue.fixed.push_back({Vec3(-1e-9, -1.0, -1.0), Vec3(1e-9, 1.0, 1.0)});
    Scene scene(config);
    const Points& rest = scene.tissues()[0].rest.nodes;
    Snapshot snapshot;
    double last = 0.0, first_zero_s = 0.0;
    int zeros = 0;
    while (scene.time() < 2.0 / expected)
    {
      EXPECT_TRUE(scene.step().converged);
      scene.fillSnapshot(snapshot);
      double part = 0.0;
      for (std::size_t i = 0; i < rest.size(); ++i)
      {
        part += shapeAt(mode, rest[i].x()) * (snapshot.tissues[0].positions[i] - rest[i])[axis];
      }
      if (part * last < 0.0)
      {
        const double zero_s = scene.time() - config.time_step_s * part / (part - last);
        if (zeros == 2)
        {
          const double found = 1.0 / (zero_s - first_zero_s);
          const double theta = 2.0 * M_PI / kSteps;
          return found * (1.0 + theta * theta / 3.0);
        }
        first_zero_s = zeros == 0 ? zero_s : first_zero_s;
        ++zeros;
      }
      last = part;
    }
    ADD_FAILURE() << "no period within " << scene.time() << " s";
    return 0.0;
  }

  /** Prints errors on three meshes. @return those, relative */
  std::array<double, 3> errorsOf(Mode mode, ElementKind element, const std::array<int, 3>& cells,
                                 double reference) const
  {
    std::array<double, 3> errors;
    for (std::size_t k = 0; k < cells.size(); ++k)
    {
      const double found = frequencyOf(mode, element, cells[k]);
      errors[k] = found / reference - 1.0;
      std::printf("  tet%s, %d cells over the thickness: %.5f Hz, %+.3f %%\n",
                  element == ElementKind::tet4 ? "4" : "10", cells[k], found, 100.0 * errors[k]);
    }
    return errors;
  }

  ScratchFolder folder_;
};

TEST_F(Vibration, OfARodAlongIt)
{
  const std::array<double, 3> quadratic =
      errorsOf(Mode::axial, ElementKind::tet10, {1, 2, 3}, kAxial);
  EXPECT_LT(std::abs(quadratic[0]), 5e-3);
  EXPECT_LT(std::abs(quadratic[2]), 5e-4);
  const std::array<double, 3> linear = errorsOf(Mode::axial, ElementKind::tet4, {1, 2, 4}, kAxial);
  const double orders[] = {std::log2(linear[0] / linear[1]), std::log2(linear[1] / linear[2])};
  std::printf("  tet4: orders %.2f %.2f\n", orders[0], orders[1]);
  EXPECT_LT(std::abs(linear[2]), 1e-3);
  for (const double order : orders)
  {
    EXPECT_NEAR(order, 1.7, 0.4);
  }
}

TEST_F(Vibration, OfABeamAcrossIt)
{
  const double rotary = kThick * kThick / (12.0 * kLength * kLength);
  const double timoshenko =
      TimoshenkoCantilever(rotary, 2.0 / (5.0 / 6.0) * rotary).firstFrequency();  // E / G = 2
  const double reference = kBending * timoshenko / 3.51602;
  std::printf("  Euler and Bernoulli %.5f Hz; shear and rotary inertia make it %.5f Hz, %+.2f %%\n",
              kBending, reference, 100.0 * (reference / kBending - 1.0));
  EXPECT_LT(reference, kBending);
  const std::array<double, 3> quadratic =
      errorsOf(Mode::bending, ElementKind::tet10, {1, 2, 3}, reference);
  EXPECT_LT(std::abs(quadratic[0]), 0.01);
  EXPECT_LT(std::abs(quadratic[2]), 0.003);
  const std::array<double, 3> linear =
      errorsOf(Mode::bending, ElementKind::tet4, {2, 4, 8}, reference);
  const double orders[] = {std::log2(linear[0] / linear[1]), std::log2(linear[1] / linear[2])};
  std::printf("  tet4: orders %.2f %.2f\n", orders[0], orders[1]);
  for (const double order : orders)
  {
    EXPECT_NEAR(order, 1.8, 0.3);
  }
}

}  // namespace
}  // namespace soft_tissue
