#include <algorithm>

#include "scene_impl.h"

namespace soft_tissue
{
namespace
{
/** BDF2 is stable in steps that grow by less than 1 + sqrt(2). */
constexpr double kMostGrowth = 2.0;

/** Contact forces of which more than this share is new, or gone, since the last step are a blow. */
constexpr double kBlow = 0.5;
}  // namespace

/** Chooses what of the past each tissue carries into a step of length h, s: after a blow or a stop,
 * and where steps get longer suddenly, nothing. */
void Scene::Impl::chooseFormulas(double h)
{
  const bool second_order = config_.solver.stepper == Stepper::bdf2 && h <= kMostGrowth * last_h_;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    formula_[k] = second_order && smooth_[k] != 0 ? StepFormula::bdf2(h, last_h_)
                                                  : StepFormula::implicitEuler(h);
  }
}

StepStart Scene::Impl::startOfPart() const
{
  return {before_, v_, x_last_, v_last_};
}

/** Gives the term of inertia the formulas of this part of a step, which starts at before_. */
void Scene::Impl::beginInertia()
{
  bool other = false;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    other |= inertia_->beginStep(tissues_[k].first_node, tissues_[k].node_count, startOfPart(),
                                 formula_[k]);
    if (drag_ != nullptr)
    {
      drag_->beginStep(tissues_[k].first_node, tissues_[k].node_count, startOfPart(), formula_[k]);
    }
  }
  if (other)
  {
    newton_->forgetMatrix();
  }
}

/** Those that are smooth_ no longer go on by implicit Euler. */
void Scene::Impl::dropThePast(double h)
{
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (smooth_[k] == 0)
    {
      formula_[k] = StepFormula::implicitEuler(h);
    }
  }
  if (isDynamic())
  {
    beginInertia();
  }
}

/** Where nodes go if the last acceleration goes on: where a minimisation may start, beside where
 * they go if no force acts. */
void Scene::Impl::extrapolate(double end_s)
{
  extrapolated_ = before_;
  if (isDynamic())
  {
    extrapolated_ = inertia_->target();
    newton_->restoreFixed(before_, extrapolated_);
    for (std::size_t k = 0; k < tissues_.size(); ++k)
    {
      const double s = formula_[k].effective_s;
      const Index end = tissues_[k].first_node + tissues_[k].node_count;
      for (Index i = tissues_[k].first_node; i < end; ++i)
      {
        extrapolated_[i] += s * s * acceleration_[i];
      }
    }
  }
  placeMovedNodes(end_s, extrapolated_);
}

/**
 * Looks for tissues that contact deals a blow in this part of a step: they smooth_ no longer is.
 *
 * What carries on the change of velocity that stopped a body throws it back, with more than it came
 * with. So contact forces which are new for the most part are for a formula without a past.
 * @return whether one with a past met any
 */
bool Scene::Impl::findBlows()
{
  bool any = false;
  for (Contact& contact : contacts_)
  {
    if (sleeps(contact))
    {
      continue;
    }
    takeForce(contact);
    double change = 0.0, now = 0.0, last = 0.0;
    for (std::size_t i = 0; i < contact.force.size(); ++i)
    {
      const Vec3 old = contact.last_force.empty() ? Vec3::Zero() : contact.last_force[i];
      change += (contact.force[i] - old).norm();
      now += contact.force[i].norm();
      last += old.norm();
    }
    if (change > kBlow * std::max(now, last))
    {
      smooth_[contact.tissue] = 0;
      any |= formula_[contact.tissue].carried > 0.0;
      if (contact.with_tissue != nullptr)
      {
        smooth_[contact.other] = 0;
        any |= formula_[contact.other].carried > 0.0;
      }
    }
  }
  return any;
}

/** Contact::force at x_. */
void Scene::Impl::takeForce(Contact& contact)
{
  contact.force.clear();
  const auto take = [&](const Tissue& tissue) {
    const auto first = contact_force_.begin() + tissue.first_node;
    contact.force.insert(contact.force.end(), first, first + tissue.node_count);
    std::fill_n(first, tissue.node_count, Vec3::Zero());
  };
  if (contact.term->active())
  {
    contact.term->addGradient(x_, contact_force_);
  }
  take(tissues_[contact.tissue]);
  if (contact.with_tissue != nullptr && contact.other != contact.tissue)
  {
    take(tissues_[contact.other]);
  }
}

/** Has the next steps carry nothing of those before. */
void Scene::Impl::forgetPast()
{
  std::fill(smooth_.begin(), smooth_.end(), 0);
  for (Contact& contact : contacts_)
  {
    contact.last_force.clear();
  }
}

}  // namespace soft_tissue
