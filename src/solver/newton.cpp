#include "soft_tissue_sim/solver/newton.h"

#include <algorithm>
#include <cmath>

#include "node_vectors.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue
{
namespace
{
constexpr double kSufficientDecrease = 1e-4;
constexpr int kMaxBacktracks = 40;
/** Rounding errors of a potential, as a share of the sum of its terms: materials subtract terms of
 * the size of their stiffness. */
constexpr double kNoise = 1e-9;
/** A full step that leaves this share of the forces unbalanced leads where it should, whatever
 * rounding makes of the potential. */
constexpr double kBalances = 0.5;
/** Full steps are lengthened where more than this share of slope times step is gained. */
constexpr double kFallsAhead = 0.75;
constexpr double kLongestStep = 64.0;
/** Relative accuracy of the first linear solve; later ones follow the progress made. */
constexpr double kFirstAccuracy = 0.01;
/** After indefinite curvature, exact curvature is tried again when the residual has fallen to this
 * share. */
constexpr double kTrustAgain = 0.1;
/** A matrix serves for another iteration when its last one left no more of the residual than this
 * beyond what the linear solver left. */
constexpr double kServesAgain = 0.1;
/** Where time is short, one that left no more than this does. */
constexpr double kLeads = 0.5;
/** Linear iterations that are done however little time there is. */
constexpr int kFewestLinear = 8;
/** Accuracy of a linear solve that is believed when it says how far the end is: what a loose one
 * leaves may be forces that soft parts feel, beside stiff ones that hide them. */
constexpr double kBelieved = 1e-6;
/** Ends that are believed to be as near as loose solves say, in a row, because such ends were. */
constexpr int kMostTrusted = 63;
/** Moves this far below the size of the coordinates are rounding errors. */
constexpr double kUnresolved = 1e-12;
}  // namespace

NewtonSolver::NewtonSolver(const Adjacency& neighbours, const std::vector<Index>& fixed,
                           std::unique_ptr<LinearSolver> linear)
    : fixed_(fixed),
      is_fixed_(neighbours.size(), false),
      hessian_(neighbours),
      linear_(std::move(linear))
{
  for (const Index row : fixed_)
  {
    is_fixed_[row] = true;
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

/** sum += part, part = 0; returns |part|^2. */
double NewtonSolver::moveInto(Points& sum, Points& part) const
{
  return parallelSum(static_cast<Index>(part.size()), kNodeGrain, [&](Index begin, Index end) {
    double squared = 0.0;
    for (Index i = begin; i < end; ++i)
    {
      sum[i] += part[i];
      squared += part[i].squaredNorm();
      part[i].setZero();
    }
    return squared;
  });
}

NewtonSolver::State NewtonSolver::evaluate(const std::vector<EnergyTerm*>& terms, const Points& x,
                                           Points& gradient, std::vector<double>& seconds)
{
  State state;
  ++evaluations_;
  gradient.resize(x.size());
  forNodes(x.size(), [&](Index i) { gradient[i].setZero(); });
  term_gradient_.resize(x.size(), Vec3::Zero());
  double scale = 0.0;
  for (std::size_t k = 0; k < terms.size(); ++k)
  {
    const ScopedTimer timer(seconds[k]);
    const double value = terms[k]->valueAndGradient(x, term_gradient_);
    state.value += value;
    state.magnitude += std::abs(value);
    for (const Index node : fixed_)
    {
      term_gradient_[node].setZero();
    }
    scale += std::sqrt(moveInto(gradient, term_gradient_));
  }
  state.force = std::sqrt(dot(gradient, gradient));
  state.residual = state.force / scale;
  if (scale == 0.0)
  {
    state.residual = state.force == 0.0 ? 0.0 : std::nan("");
  }
  return state;
}

void NewtonSolver::assemble(const std::vector<EnergyTerm*>& terms, const Points& x,
                            Curvature curvature, NewtonReport& report, std::vector<double>& seconds)
{
  const Timer whole;
  ++evaluations_;
  hessian_.setZero();
  for (std::size_t k = 0; k < terms.size(); ++k)
  {
    const ScopedTimer timer(seconds[k]);
    terms[k]->addHessian(x, curvature, hessian_);
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
  for (Coupling& coupling : hessian_.couplings())
  {
    if (is_fixed_[coupling.row] || is_fixed_[coupling.column])
    {
      coupling.block.setZero();
    }
  }
  OuterProducts& outer = hessian_.outer();
  for (std::size_t place = 0; place < outer.nodes().size(); ++place)
  {
    if (is_fixed_[outer.nodes()[place]])
    {
      std::fill_n(outer.vector(static_cast<Index>(place)), 3, 0.0);
    }
  }
  {
    const ScopedTimer timer(report.linear_s);
    linear_->setMatrix(hessian_, x);
    matrix_at_ = x;
  }
  assembly_s_ = whole.seconds();
}

int NewtonSolver::affordableLinearIterations() const
{
  const double left_s = std::max(budget_s_ - evaluation_s_ - timer_.seconds(), 0.0);
  constexpr double kMost = std::numeric_limits<int>::max();
  return left_s < kMost * linear_iteration_s_
             ? std::max(static_cast<int>(left_s / linear_iteration_s_), kFewestLinear)
             : std::numeric_limits<int>::max();
}

/** Solves for direction_. */
LinearReport NewtonSolver::solve(double accuracy, NewtonReport& report)
{
  const Timer timer;
  const LinearReport linear =
      linear_->solve(descent_, accuracy, affordableLinearIterations(), direction_);
  const double spent_s = timer.seconds();
  report.linear_s += spent_s;
  report.linear_iterations += linear.iterations;
  linear_iteration_s_ = spent_s / std::max(linear.iterations, 1);
  return linear;
}

/** Solves for direction_ with second derivatives at x: exact, or positive where those fail. */
LinearReport NewtonSolver::solveAnew(const std::vector<EnergyTerm*>& terms, const Points& x,
                                     double residual, double accuracy, NewtonReport& report,
                                     std::vector<double>& seconds)
{
  if (indefinite_at_ == 0.0 || residual < kTrustAgain * indefinite_at_)
  {
    assemble(terms, x, Curvature::exact, report, seconds);
    const LinearReport linear = solve(accuracy, report);
    if (!linear.indefinite)
    {
      return linear;
    }
    indefinite_at_ = residual;
  }
  assemble(terms, x, Curvature::positive, report, seconds);
  return solve(accuracy, report);
}

/** Whether the forces left would move no node by more than `within`, m, by the second derivatives
 * at hand, where a loose solve says so. That is looked at closely where stiff parts may hide soft
 * ones, and elsewhere now and then: the more rarely the more often it was right. */
bool NewtonSolver::endsWithin(double within, NewtonReport& report)
{
  if (trusted_ > 0 && !linear_->isUneven())
  {
    --trusted_;
    return true;
  }
  takeDescent();
  const LinearReport linear = solve(kBelieved, report);
  const bool near = !linear.indefinite && !linear.cut_short && largest(direction_) <= within;
  trust_ = near ? std::min(2 * trust_ + 1, kMostTrusted) : 0;
  trusted_ = trust_;
  return near;
}

void NewtonSolver::takeDescent()
{
  forNodes(gradient_.size(), [&](Index i) { descent_[i] = -gradient_[i]; });
}

/** Goes to trial_ and trial_gradient_. */
NewtonSolver::State NewtonSolver::tryStep(const std::vector<EnergyTerm*>& terms, const Points& x,
                                          double step, std::vector<double>& seconds)
{
  forNodes(x.size(), [&](Index i) { trial_[i] = x[i] + step * direction_[i]; });
  return evaluate(terms, trial_, trial_gradient_, seconds);
}

/** Goes from x along direction_ to trial_ until the potential has fallen enough.
 * @param state  in: at x, out: at trial_
 * @return the step's length in units of direction_; 0: nowhere */
double NewtonSolver::searchLine(const std::vector<EnergyTerm*>& terms, const Points& x,
                                State& state, std::vector<double>& seconds)
{
  const double slope = dot(gradient_, direction_);
  if (!(slope < 0.0))
  {
    return 0.0;  // no way down that rounding errors leave visible
  }
  const State start = state;
  double step = 1.0;
  for (int k = 0;; ++k, step *= 0.5)
  {
    if (k == kMaxBacktracks)
    {
      return 0.0;
    }
    state = tryStep(terms, x, step, seconds);
    if (!std::isfinite(state.residual))
    {
      continue;
    }
    if (state.value <= start.value + kSufficientDecrease * step * slope)
    {
      break;
    }
    // Close to the bottom values drown in rounding errors: what slopes say then counts.
    const bool level = state.value <= start.value + kNoise * start.magnitude;
    const bool flatter =
        dot(trial_gradient_, direction_) <= (2.0 * kSufficientDecrease - 1.0) * slope;
    const bool balanced = step == 1.0 && dot(trial_gradient_, trial_gradient_) <=
                                             kBalances * kBalances * dot(gradient_, gradient_);
    if (flatter && (level || balanced))
    {
      break;
    }
  }
  // A bowl gives half of what the slope promises. Where the potential keeps that promise the way
  // leads off a saddle, and its positive part knows no length: go on.
  while (step >= 1.0 && step < kLongestStep &&
         start.value - state.value > kFallsAhead * step * -slope)
  {
    const State further = tryStep(terms, x, 2.0 * step, seconds);
    if (!(further.value < state.value) || !std::isfinite(further.residual))
    {
      tryStep(terms, x, step, seconds);
      break;
    }
    step *= 2.0;
    state = further;
  }
  return step;
}

NewtonReport NewtonSolver::minimise(const std::vector<EnergyTerm*>& terms,
                                    const NewtonOptions& options, Points& x,
                                    std::vector<double>& seconds, Points* other)
{
  NewtonReport report;
  timer_.restart();
  budget_s_ = options.budget_s;
  evaluations_ = 0;
  const std::size_t n = x.size();
  descent_.resize(n);
  trial_.resize(n);
  State state = evaluate(terms, x, gradient_, seconds);
  evaluation_s_ = timer_.seconds();
  if (other != nullptr && *other != x)
  {
    const State there = evaluate(terms, *other, trial_gradient_, seconds);
    if (there.value < state.value)
    {
      x.swap(*other);
      gradient_.swap(trial_gradient_);
      state = there;
    }
  }
  const double size = largest(x);
  double accuracy = kFirstAccuracy;
  indefinite_at_ = 0.0;
  if (terms != matrix_terms_)
  {
    forgetMatrix();
  }
  bool settled = false;
  while (!settled && std::isfinite(state.value) && state.residual > options.tolerance &&
         report.iterations < options.max_iterations)
  {
    const double begun_s = timer_.seconds();
    const double spare_s = budget_s_ - begun_s - directing_s_;
    const bool anew = !matrix_serves_ && (spare_s >= assembly_s_ || !matrix_leads_);
    report.out_of_time = report.iterations > 0 && spare_s < (anew ? assembly_s_ : 0.0);
    if (report.out_of_time)
    {
      break;
    }
    ++report.iterations;
    takeDescent();
    // More than the tolerance asked for is lost on this iteration.
    accuracy = std::max({accuracy, 1e-10, 0.3 * options.tolerance / state.residual});
    accuracy = std::min(accuracy, 0.1);
    const LinearReport linear = anew
                                    ? solveAnew(terms, x, state.residual, accuracy, report, seconds)
                                    : solve(accuracy, report);
    const double longest = largest(direction_);
    // What was cut short has not seen the slow motions.
    const double reach = longest / state.force;
    reach_ = linear.cut_short && reach_ > reach ? reach_ : reach;
    const double unresolved = kUnresolved * size;
    settled = anew && !linear.indefinite && !linear.cut_short && longest <= unresolved &&
              endsWithin(unresolved, report);
    if (settled)
    {
      break;
    }
    State next = state;
    const double step = anew || !linear.indefinite ? searchLine(terms, x, next, seconds) : 0.0;
    if (step == 0.0 && anew)
    {
      break;
    }
    const double left = step > 0.0 ? next.residual / state.residual : 1.0;
    matrix_serves_ = step == 1.0 && left - linear.residual <= kServesAgain;
    matrix_leads_ = step == 1.0 && left - linear.residual <= kLeads;
    matrix_terms_ = terms;
    if (step > 0.0)
    {
      x.swap(trial_);
      gradient_.swap(trial_gradient_);
      state = next;
      settled = step == 1.0 && state.residual > options.tolerance &&
                left * longest <= options.settled && !linear.cut_short &&
                endsWithin(options.settled, report);
      accuracy = left * left;
    }
    directing_s_ = timer_.seconds() - begun_s - (anew ? assembly_s_ : 0.0);
  }
  report.evaluations = evaluations_;
  report.value = state.value;
  report.residual = state.residual;
  report.position_error_m = reach_ * state.force;
  report.finite = std::isfinite(state.residual) && std::isfinite(state.value);
  report.converged = settled || state.residual <= options.tolerance;
  return report;
}

}  // namespace soft_tissue
