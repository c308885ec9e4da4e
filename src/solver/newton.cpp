#include "soft_tissue_sim/solver/newton.h"

#include <algorithm>
#include <cmath>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue
{
namespace
{
constexpr Index kGrain = 512;
constexpr double kSufficientDecrease = 1e-4;
constexpr int kMaxBacktracks = 40;

double dot(const Points& a, const Points& b)
{
  return parallelSum(static_cast<Index>(a.size()), kGrain, [&](Index begin, Index end) {
    double sum = 0.0;
    for (Index i = begin; i < end; ++i)
    {
      sum += a[i].dot(b[i]);
    }
    return sum;
  });
}

void setZero(Points& points, std::size_t size)
{
  points.assign(size, Vec3::Zero());
}
}  // namespace

NewtonSolver::NewtonSolver(const Adjacency& neighbours, const std::vector<Index>& fixed,
                           std::unique_ptr<LinearSolver> linear)
    : fixed_(fixed), hessian_(neighbours), linear_(std::move(linear))
{
  for (const Index row : fixed_)
  {
    for (Index k = hessian_.offsets()[row]; k < hessian_.offsets()[row + 1]; ++k)
    {
      fixed_blocks_.push_back(k);
      fixed_blocks_.push_back(hessian_.find(hessian_.columns()[k], row));
    }
  }
  std::sort(fixed_blocks_.begin(), fixed_blocks_.end());
  fixed_blocks_.erase(std::unique(fixed_blocks_.begin(), fixed_blocks_.end()), fixed_blocks_.end());
}

void NewtonSolver::restoreFixed(const Points& from, Points& to) const
{
  for (const Index node : fixed_)
  {
    to[node] = from[node];
  }
}

NewtonSolver::Potential NewtonSolver::evaluate(const std::vector<EnergyTerm*>& terms,
                                               const Points& x, std::vector<double>& seconds)
{
  Potential sum;
  for (std::size_t k = 0; k < terms.size(); ++k)
  {
    const ScopedTimer timer(seconds[k]);
    const double value = terms[k]->value(x);
    sum.value += value;
    sum.magnitude += std::abs(value);
  }
  return sum;
}

double NewtonSolver::gradient(const std::vector<EnergyTerm*>& terms, const Points& x,
                              std::vector<double>& seconds)
{
  setZero(gradient_, x.size());
  double scale = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k)
  {
    const ScopedTimer timer(seconds[k]);
    setZero(term_gradient_, x.size());
    terms[k]->addGradient(x, term_gradient_);
    for (const Index node : fixed_)
    {
      term_gradient_[node].setZero();
    }
    scale += std::sqrt(dot(term_gradient_, term_gradient_));
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      gradient_[i] += term_gradient_[i];
    }
  }
  const double norm = std::sqrt(dot(gradient_, gradient_));
  if (scale == 0.0)
  {
    return norm == 0.0 ? 0.0 : std::nan("");
  }
  return norm / scale;
}

void NewtonSolver::assemble(const std::vector<EnergyTerm*>& terms, const Points& x,
                            std::vector<double>& seconds)
{
  hessian_.setZero();
  for (std::size_t k = 0; k < terms.size(); ++k)
  {
    const ScopedTimer timer(seconds[k]);
    terms[k]->addHessian(x, hessian_);
  }
  // Fixed nodes: rows and columns of the identity.
  for (const Index position : fixed_blocks_)
  {
    std::fill_n(hessian_.block(position), 9, 0.0);
  }
  for (const Index node : fixed_)
  {
    double* block = hessian_.block(hessian_.diagonal(node));
    block[0] = block[4] = block[8] = 1.0;
  }
}

NewtonReport NewtonSolver::minimise(const std::vector<EnergyTerm*>& terms,
                                    const NewtonOptions& options, Points& x,
                                    std::vector<double>& seconds)
{
  NewtonReport report;
  const auto overflowed = [&report] {
    report.finite = false;
    return report;
  };
  const std::size_t n = x.size();
  report.residual = gradient(terms, x, seconds);
  if (!std::isfinite(report.residual))
  {
    return overflowed();
  }
  if (report.residual <= options.tolerance)
  {
    report.converged = true;
    return report;
  }
  Potential potential = evaluate(terms, x, seconds);
  if (!std::isfinite(potential.value))
  {
    return overflowed();
  }
  descent_.resize(n);
  trial_.resize(n);
  while (report.iterations < options.max_iterations)
  {
    ++report.iterations;
    assemble(terms, x, seconds);
    for (std::size_t i = 0; i < n; ++i)
    {
      descent_[i] = -gradient_[i];
    }
    {
      // As exact as this iteration can use: an error below the tolerance asked for is lost on the
      // next one.
      const ScopedTimer timer(report.linear_s);
      const double accuracy = std::clamp(0.3 * options.tolerance / report.residual, 1e-10, 0.1);
      report.linear_iterations += linear_->solve(hessian_, descent_, accuracy, direction_);
    }
    const double slope = dot(gradient_, direction_);
    if (!std::isfinite(slope))
    {
      return overflowed();
    }
    if (!(slope < 0.0))
    {
      break;  // no way down that rounding errors leave visible
    }
    double step = 1.0;
    bool accepted = false;
    for (int k = 0; k < kMaxBacktracks && !accepted; ++k, step *= 0.5)
    {
      for (std::size_t i = 0; i < n; ++i)
      {
        trial_[i] = x[i] + step * direction_[i];
      }
      const Potential next = evaluate(terms, trial_, seconds);
      const double rounding = 4e-15 * std::max(next.magnitude, potential.magnitude);
      if (next.value <= potential.value + kSufficientDecrease * step * slope + rounding)
      {
        potential = next;
        accepted = true;
      }
    }
    if (!accepted)
    {
      break;
    }
    x.swap(trial_);
    report.residual = gradient(terms, x, seconds);
    if (!std::isfinite(report.residual))
    {
      x.swap(trial_);
      return overflowed();
    }
    if (report.residual <= options.tolerance)
    {
      report.converged = true;
      break;
    }
  }
  return report;
}

}  // namespace soft_tissue
