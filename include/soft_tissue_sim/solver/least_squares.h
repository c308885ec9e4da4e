#pragma once

#include <Eigen/Core>
#include <functional>

namespace soft_tissue
{
struct LeastSquaresOptions
{
  Eigen::VectorXd lower, upper;  ///< P each, bounds of the parameters
  double difference = 0.01;      ///< of a parameter, for derivatives by one-sided differences
  double tolerance = 1e-4;       ///< ends when no parameter would move by more
  int max_iterations = 30;
};

struct LeastSquaresFit
{
  Eigen::VectorXd parameters;  ///< P
  /** P, half of each one's 95 % confidence interval. */
  Eigen::VectorXd half_width;
  double root_mean_square = 0.0;  ///< of the residuals
  int iterations = 0;
  int evaluations = 0;  ///< of the residuals
  bool converged = false;
};

/**
 * Residuals for P parameters: N samples in their order in time, each of some channels, one after
 * the other. N stays the same.
 */
using Residuals = std::function<Eigen::VectorXd(const Eigen::VectorXd& parameters)>;

/**
 * Makes the sum of squares of residuals that each cost a simulation small, by Levenberg and
 * Marquardt's method.
 *
 * What is left of the residuals is seldom white: neighbours in time err alike, and N of them tell
 * less than N independent ones. Intervals come from the long-run covariance of their products with
 * the derivatives, weighted as by Bartlett, with the quantiles that belong to as long a window.
 * @param start     P, inside the bounds
 * @param channels  of a sample; divides the number of residuals
 * @throws Error for fewer samples than parameters need, residuals that are not finite at the start,
 * or a parameter that they do not depend on
 * Source: Kiefer and Vogelsang 2005 (quantiles), Andrews 1991 (length of the window).
 */
LeastSquaresFit fitLeastSquares(const Residuals& residuals, const Eigen::VectorXd& start,
                                int channels, const LeastSquaresOptions& options);

}  // namespace soft_tissue
