#include "soft_tissue_sim/solver/least_squares.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDampingStart = 1e-3, kDampingFactor = 10.0;
constexpr double kDampingLeast = 1e-9, kDampingMost = 1e9;
/** Of the samples, the longest window that their covariance is summed over. */
constexpr double kLongestWindow = 0.5;

/** The window's length that suits first-order autoregressive series, T x P, in samples. */
double andrewsWindow(const MatrixXd& series)
{
  double above = 0.0, below = 0.0;
  const Eigen::Index n = series.rows();
  for (Eigen::Index k = 0; k < series.cols(); ++k)
  {
    const auto before = series.col(k).head(n - 1), after = series.col(k).tail(n - 1);
    const double power = before.squaredNorm();
    if (!(power > 0.0))
    {
      continue;
    }
    const double rho = std::min(before.dot(after) / power, 0.999);
    const double noise = (after - rho * before).squaredNorm() / static_cast<double>(n - 1);
    above += 4.0 * rho * rho * noise * noise / (std::pow(1.0 - rho, 6) * std::pow(1.0 + rho, 2));
    below += noise * noise / std::pow(1.0 - rho, 4);
  }
  return below > 0.0 ? 1.1447 * std::cbrt(above / below * static_cast<double>(n)) : 1.0;
}

/** 97.5 % quantile of an estimate over its deviation by a Bartlett window of this share. */
double quantile(double share)
{
  return 1.96 + share * (2.9694 + share * (0.4160 - 0.5324 * share));
}

VectorXd halfWidths(const MatrixXd& jacobian, const VectorXd& residuals, int channels)
{
  const Eigen::Index samples = residuals.size() / channels, parameters = jacobian.cols();
  MatrixXd scores = MatrixXd::Zero(samples, parameters);
  for (Eigen::Index i = 0; i < residuals.size(); ++i)
  {
    scores.row(i / channels) += residuals[i] * jacobian.row(i);
  }
  const double n = static_cast<double>(samples);
  const double window =
      std::clamp(std::max(andrewsWindow(scores), std::sqrt(n)), 1.0, kLongestWindow * n);
  MatrixXd sum = scores.transpose() * scores;
  for (Eigen::Index lag = 1; lag < std::min<Eigen::Index>(samples, std::ceil(window)); ++lag)
  {
    const MatrixXd shifted =
        scores.topRows(samples - lag).transpose() * scores.bottomRows(samples - lag);
    sum += (1.0 - static_cast<double>(lag) / window) * (shifted + shifted.transpose());
  }
  const MatrixXd inverse =
      (jacobian.transpose() * jacobian).ldlt().solve(MatrixXd::Identity(parameters, parameters));
  const VectorXd variance = (inverse * sum * inverse).diagonal().cwiseMax(0.0);
  return quantile(window / n) *
         (variance * (n / (n - static_cast<double>(parameters)))).cwiseSqrt();
}

/** One fit: where it is, and what it has found there. */
class Fit
{
 public:
  Fit(const Residuals& residuals, const VectorXd& start, const LeastSquaresOptions& options)
      : residuals_(residuals), options_(options), parameters_(start), at_(evaluate(start))
  {
    if (!at_.allFinite())
    {
      throw Error("the residuals are not finite where the fit starts");
    }
  }

  /** Moves downhill once. @return whether nothing is left to move */
  bool iterate()
  {
    differentiate();
    const MatrixXd normal = jacobian_.transpose() * jacobian_;
    const VectorXd slope = jacobian_.transpose() * at_;
    for (; damping_ <= kDampingMost; damping_ *= kDampingFactor)
    {
      MatrixXd damped = normal;
      damped.diagonal() *= 1.0 + damping_;
      const VectorXd wanted = parameters_ - damped.ldlt().solve(slope);
      const VectorXd next = wanted.cwiseMax(options_.lower).cwiseMin(options_.upper);
      if ((next - parameters_).cwiseAbs().maxCoeff() <= options_.tolerance)
      {
        return true;
      }
      const VectorXd there = evaluate(next);
      if (there.allFinite() && there.squaredNorm() < at_.squaredNorm())
      {
        parameters_ = next;
        at_ = there;
        damping_ = std::max(damping_ / kDampingFactor, kDampingLeast);
        return false;
      }
    }
    return true;
  }

  const VectorXd& parameters() const { return parameters_; }
  const VectorXd& residuals() const { return at_; }
  const MatrixXd& jacobian() const { return jacobian_; }
  int evaluations() const { return evaluations_; }

 private:
  VectorXd evaluate(const VectorXd& parameters)
  {
    ++evaluations_;
    return residuals_(parameters);
  }

  void differentiate()
  {
    jacobian_.resize(at_.size(), parameters_.size());
    for (Eigen::Index k = 0; k < parameters_.size(); ++k)
    {
      VectorXd beside = parameters_;
      const bool up = beside[k] + options_.difference <= options_.upper[k];
      const double step = up ? options_.difference : -options_.difference;
      beside[k] += step;
      jacobian_.col(k) = (evaluate(beside) - at_) / step;
      if (!jacobian_.col(k).allFinite() || jacobian_.col(k).isZero(0.0))
      {
        throw Error("parameter " + std::to_string(k + 1) +
                    ": nothing that is fitted depends on it");
      }
    }
  }

  const Residuals& residuals_;
  const LeastSquaresOptions& options_;
  int evaluations_ = 0;  ///< before what is evaluated
  VectorXd parameters_, at_;
  MatrixXd jacobian_;
  double damping_ = kDampingStart;
};
}  // namespace

LeastSquaresFit fitLeastSquares(const Residuals& residuals, const VectorXd& start, int channels,
                                const LeastSquaresOptions& options)
{
  Fit fit(residuals, start, options);
  const Eigen::Index samples = fit.residuals().size() / channels;
  if (samples <= start.size())
  {
    throw Error(std::to_string(samples) + " samples are too few for " +
                std::to_string(start.size()) + " parameters");
  }
  LeastSquaresFit found;
  while (!found.converged && found.iterations < options.max_iterations)
  {
    found.converged = fit.iterate();
    ++found.iterations;
  }
  found.parameters = fit.parameters();
  found.half_width = halfWidths(fit.jacobian(), fit.residuals(), channels);
  found.root_mean_square =
      std::sqrt(fit.residuals().squaredNorm() / static_cast<double>(fit.residuals().size()));
  found.evaluations = fit.evaluations();
  return found;
}

}  // namespace soft_tissue
