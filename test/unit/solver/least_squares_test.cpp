#include "soft_tissue_sim/solver/least_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
using Eigen::VectorXd;

LeastSquaresOptions wide(Eigen::Index parameters)
{
  LeastSquaresOptions options;
  options.lower = VectorXd::Constant(parameters, -100.0);
  options.upper = VectorXd::Constant(parameters, 100.0);
  return options;
}

/** Noise in which each sample keeps this share of the one before; variance 1. */
VectorXd noise(int count, double kept, std::mt19937& random)
{
  std::normal_distribution<double> normal;
  VectorXd series(count);
  double value = normal(random);
  for (int i = 0; i < count; ++i)
  {
    series[i] = value;
    value = kept * value + std::sqrt(1.0 - kept * kept) * normal(random);
  }
  return series;
}

TEST(LeastSquares, EndsAtTheBottomOfACurvedValley)
{
  const Residuals rosenbrock = [](const VectorXd& p) {
    VectorXd r(4);
    r << 10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0], 0.0, 0.0;
    return r;
  };
  LeastSquaresOptions options = wide(2);
  options.difference = 1e-6;
  options.tolerance = 1e-9;
  options.max_iterations = 100;
  const LeastSquaresFit fit = fitLeastSquares(rosenbrock, Eigen::Vector2d(-1.2, 1.0), 1, options);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.parameters[0], 1.0, 1e-6);
  EXPECT_NEAR(fit.parameters[1], 1.0, 1e-6);
  EXPECT_NEAR(fit.root_mean_square, 0.0, 1e-6);
}

TEST(LeastSquares, StaysInsideItsBounds)
{
  const Residuals beyond = [](const VectorXd& p) {
    return VectorXd(VectorXd::Constant(5, 3.0 - p[0]));
  };
  LeastSquaresOptions options = wide(1);
  options.upper[0] = 2.0;
  const LeastSquaresFit fit = fitLeastSquares(beyond, VectorXd::Constant(1, 1.0), 1, options);
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.parameters[0], 2.0);
}

// The truth lies in 95 of 100 intervals, whatever neighbours have in common: taken for independent,
// samples that keep 0.95 of the one before would catch it in half as many.
TEST(LeastSquares, IntervalsHoldTheTruthAsOftenAsTheySay)
{
  constexpr int kSamples = 400, kTrials = 400;
  std::mt19937 random(7);
  for (const double kept : {0.0, 0.8, 0.95})
  {
    int caught = 0;
    double width = 0.0;
    for (int trial = 0; trial < kTrials; ++trial)
    {
      VectorXd measured = noise(kSamples, kept, random);
      for (int i = 0; i < kSamples; ++i)
      {
        measured[i] += 2.0 * std::exp(0.3) * std::sin(0.02 * i);
      }
      const Residuals misfit = [&](const VectorXd& p) {
        VectorXd r(kSamples);
        for (int i = 0; i < kSamples; ++i)
        {
          r[i] = 2.0 * std::exp(p[0]) * std::sin(0.02 * i) - measured[i];
        }
        return r;
      };
      const LeastSquaresFit fit = fitLeastSquares(misfit, VectorXd::Zero(1), 1, wide(1));
      caught += std::abs(fit.parameters[0] - 0.3) <= fit.half_width[0] ? 1 : 0;
      width += fit.half_width[0] / kTrials;
    }
    std::printf("  neighbours keep %.2f: %d of %d intervals of +-%.4f hold the truth\n", kept,
                caught, kTrials, width);
    EXPECT_GT(caught, 0.88 * kTrials) << kept;
    EXPECT_LT(caught, 0.995 * kTrials) << kept;
  }
}

// Two channels at a time that err alike are no more than one.
TEST(LeastSquares, ChannelsOfASampleCountTogether)
{
  std::mt19937 random(11);
  const VectorXd once = noise(300, 0.5, random);
  VectorXd twice(600);
  for (int i = 0; i < 600; ++i)
  {
    twice[i] = once[i / 2];
  }
  const auto meanOf = [](const VectorXd& series, int channels) {
    const Residuals misfit = [&](const VectorXd& p) { return VectorXd(series.array() - p[0]); };
    LeastSquaresOptions options = wide(1);
    options.tolerance = 1e-9;
    return fitLeastSquares(misfit, VectorXd::Zero(1), channels, options);
  };
  const LeastSquaresFit one = meanOf(once, 1), two = meanOf(twice, 2);
  EXPECT_NEAR(one.parameters[0], once.mean(), 1e-6);
  EXPECT_NEAR(two.half_width[0], one.half_width[0], 1e-9);
}

TEST(LeastSquares, RefusesWhatTellsNothing)
{
  const Residuals constant = [](const VectorXd&) { return VectorXd(VectorXd::Ones(10)); };
  EXPECT_THROW(fitLeastSquares(constant, VectorXd::Zero(1), 1, wide(1)), Error);
  const Residuals short_one = [](const VectorXd& p) {
    return VectorXd(VectorXd::Constant(3, p[0]));
  };
  EXPECT_THROW(fitLeastSquares(short_one, VectorXd::Zero(1), 3, wide(1)), Error);
  const Residuals lost = [](const VectorXd&) {
    return VectorXd(VectorXd::Constant(10, std::numeric_limits<double>::quiet_NaN()));
  };
  EXPECT_THROW(fitLeastSquares(lost, VectorXd::Zero(1), 1, wide(1)), Error);
}

}  // namespace
}  // namespace soft_tissue
