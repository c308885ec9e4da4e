#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "scene_impl.h"
#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue
{
namespace
{
/** How often contact that is too deep is made stiffer within a step. */
constexpr int kMostStiffenings = 12;
}  // namespace

const StepReport& Scene::Impl::step()
{
  step_timer_.restart();
  const std::uint64_t number = report_.step + 1;
  was_held_ = report_.held;
  const double start_s = report_.time_s;
  aimTools();
  wakeUp();
  easeDeepStarts();
  report_ = StepReport();
  report_.step = number;
  report_.time_s = start_s;
  report_.parts = was_held_ ? 1 : partsOfStep();  // the way back of tools is none through tissue
  report_.converged = true;
  before_step_ = x_;
  forTets([](TissueElasticity& tets) { tets.save(); });
  for (Tissue& tissue : tissues_)
  {
    tissue.evaluations = 0;
  }
  budget_.begin(wholeBudget());
  const bool any_awake = sleepers() < tissues_.size();
  report_.position_error_m = any_awake ? std::nan("") : 0.0;
  for (int part = 0; any_awake && part < report_.parts && !report_.held; ++part)
  {
    const double from = static_cast<double>(part) / report_.parts;
    const double to = static_cast<double>(part + 1) / report_.parts;
    if (!advance(from, to, 0))
    {
      x_ = before_step_;
      forTets([](TissueElasticity& tets) { tets.restore(); });
      stop();
      forgetPast();
      reportEnd();
      report_.held = true;
    }
  }
  report_.sleeping = static_cast<int>(sleepers());
  fallAsleep();
  report_.time_s = start_s + config_.time_step_s;
  const Timer finish;
  finishStep();
  finish_s_ = finish.seconds();
  report_.ms.total = 1e3 * step_timer_.seconds();
  return report_;
}

/** Wall time from the step's beginning to the end of its last minimisation, s. */
std::optional<double> Scene::Impl::wholeBudget() const
{
  return config_.solver.budget_ms
             ? std::optional<double>(1e-3 * *config_.solver.budget_ms - finish_s_)
             : std::nullopt;
}

/** Wall time the running part of the step still has, s. */
double Scene::Impl::timeLeft() const
{
  return budget_.left(step_timer_.seconds());
}

/** Moves on through the part [from, to] of the step, halving it as often as needed. */
bool Scene::Impl::advance(double from, double to, int depth)
{
  SavedState& saved = saved_[depth];
  saved.x = x_;
  saved.v = v_;
  saved.acceleration = acceleration_;
  if (minimise(from, to))
  {
    reportEnd();
    return true;
  }
  x_ = saved.x;
  v_ = saved.v;
  acceleration_ = saved.acceleration;
  if (depth == kMaxHalvings)
  {
    return false;
  }
  ++report_.halvings;
  const double middle = 0.5 * (from + to);
  return advance(from, middle, depth + 1) && advance(middle, to, depth + 1);
}

/** One minimisation of the potential over the part [from, to] of the step; another one where a blow
 * turns out to need another formula. */
bool Scene::Impl::minimise(double from, double to)
{
  const double h = (to - from) * config_.time_step_s;
  budget_.beginPart(from, to, step_timer_.seconds());
  terms_.clear();
  terms_.push_back(gravity_.get());
  before_ = x_;
  if (isDynamic())
  {
    chooseFormulas(h);
    beginInertia();
    terms_.push_back(inertia_.get());
    if (drag_ != nullptr)
    {
      terms_.push_back(drag_.get());
    }
  }
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    Tissue& tissue = tissues_[k];
    if (asleep_[k] != 0)
    {
      continue;
    }
    if (tissue.tets != nullptr)
    {
      tissue.tets->beginStep(x_, h);
      tissue.tets->addTerms(terms_);
    }
    else
    {
      terms_.push_back(tissue.membrane.get());
    }
  }
  const std::size_t first_contact = terms_.size();
  extrapolate(report_.time_s + to * config_.time_step_s);
  beginContacts(from, to);
  beginAttachments(to);
  term_seconds_.assign(terms_.size(), 0.0);
  NewtonReport newton = findBalance();
  bool unfinished = false;
  if (config_.solver.stepper == Stepper::bdf2)
  {
    std::fill(smooth_.begin(), smooth_.end(), 1);
    while (newton.finite && !unfinished && findBlows())
    {
      dropThePast(h);
      unfinished = timeLeft() <= 0.0;
      if (!unfinished)
      {
        extrapolate(report_.time_s + to * config_.time_step_s);
        newton = findBalance();
      }
    }
  }
  for (std::size_t k = 0; k < first_contact; ++k)
  {
    report_.ms.fem += 1e3 * term_seconds_[k];
  }
  const double failed = std::max(kFailedResidual, config_.solver.tolerance);
  // Where no time is left, halves of the step would only make it later.
  const bool far = !newton.converged && newton.residual > failed;
  unfinished |= far && (newton.out_of_time || timeLeft() <= 0.0);
  newton.out_of_time |= unfinished;
  end_ = newton;
  unfinished |= far && was_held_;  // to be held again would not bring it on
  if (!newton.finite || (far && !unfinished))
  {
    std::fill(smooth_.begin(), smooth_.end(), 0);
    return false;
  }
  if (unfinished)
  {
    standStillIfBetter(h);
  }
  if (isDynamic())
  {
    takeVelocities(h);
  }
  else
  {
    stop();
  }
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (asleep_[k] == 0 && tissues_[k].tets != nullptr)
    {
      tissues_[k].tets->endStep(x_);
    }
  }
  return true;
}

/** Minimises what terms_ add up to, from where nodes would go by themselves, and with contact as
 * stiff as it has to be. */
NewtonReport Scene::Impl::findBalance()
{
  x_ = extrapolated_;
  if (isDynamic())
  {
    x_ = inertia_->target();
    newton_->restoreFixed(extrapolated_, x_);
  }
  NewtonReport newton = descend(isDynamic() ? &extrapolated_ : nullptr);
  for (int k = 0; k < kMostStiffenings && newton.converged && stiffenWhereTooDeep(); ++k)
  {
    newton = descend(nullptr);
  }
  return newton;
}

/** Minimises what terms_ add up to from x_ or another start, and reports how that went. */
NewtonReport Scene::Impl::descend(Points* other)
{
  newton_options_.budget_s = timeLeft();
  const NewtonReport newton = newton_->minimise(terms_, newton_options_, x_, term_seconds_, other);
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    tissues_[k].evaluations += asleep_[k] == 0 ? newton.evaluations : 0;
  }
  report_.ms.solve += 1e3 * newton.linear_s;
  report_.newton_iterations += newton.iterations;
  report_.linear_iterations += newton.linear_iterations;
  return newton;
}

/** Tells how the last minimisation ended; of a step in parts, how the worst of them did. */
void Scene::Impl::reportEnd()
{
  report_.residual = std::max(end_.residual, report_.residual);  // no number stays none
  report_.converged &= end_.converged;
  report_.out_of_time |= end_.out_of_time;
  report_.position_error_m = std::fmax(report_.position_error_m, end_.position_error_m);
}

/** A step left far from its end must not add energy: the potential there is at most that of a body
 * that stays where it was. That tells of energies where nothing of the past is carried on. */
void Scene::Impl::standStillIfBetter(double h)
{
  std::fill(smooth_.begin(), smooth_.end(), 0);
  dropThePast(h);
  double still = 0.0, moved = 0.0;
  for (EnergyTerm* term : terms_)
  {
    still += term->value(before_);
    moved += term->value(x_);
  }
  if (still < moved)
  {
    x_ = before_;
  }
}

/** Puts nodes that key frames move where they are at a time. */
void Scene::Impl::placeMovedNodes(double time_s, Points& x) const
{
  for (const MovedNodes& moved : moved_)
  {
    const Pose pose = moved.track.at(time_s) * moved.X_FW;
    for (std::size_t k = 0; k < moved.rows.size(); ++k)
    {
      x[moved.rows[k]] = pose * x_rest_[moved.rows[k]];
    }
  }
}

void Scene::Impl::stop()
{
  std::fill(v_.begin(), v_.end(), Vec3::Zero());
  std::fill(acceleration_.begin(), acceleration_.end(), Vec3::Zero());
}

/** What the finished step looks like: forces on tools, worst tet, deepest contact, times. */
void Scene::Impl::finishStep()
{
  std::for_each(tools_.begin(), tools_.end(), arrive);
  collectContacts();
  const Timer timer;
  report_.min_det_f = config_.tissues.empty() ? 1.0 : 1e300;
  for (Tissue& tissue : tissues_)
  {
    if (tissue.tets != nullptr)
    {
      tissue.min_det_f =
          tissue.evaluations > 0 || report_.held ? tissue.tets->minDetF(x_) : tissue.min_det_f;
      report_.min_det_f = std::min(report_.min_det_f, tissue.min_det_f);
    }
  }
  report_.ms.fem += 1e3 * timer.seconds();
  for (const Contact& contact : contacts_)
  {
    const ContactTimes times = contact.term->takeTimes();
    report_.ms.field += 1e3 * times.field;
    report_.ms.detect += 1e3 * times.detect;
    report_.ms.respond += 1e3 * times.respond;
  }
}

}  // namespace soft_tissue
