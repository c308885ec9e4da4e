#include <Eigen/Dense>
#include <algorithm>

#include "scene_impl.h"

namespace soft_tissue
{
namespace
{
/** The angular velocity that has this angular momentum; none about an axis without inertia. */
Vec3 angularVelocity(const Mat3& inertia, const Vec3& spin)
{
  constexpr double kThin = 1e-9;
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(inertia);
  Vec3 along = axes.eigenvectors().transpose() * spin;
  for (int k = 0; k < 3; ++k)
  {
    const double moment = axes.eigenvalues()[k];
    along[k] = moment > kThin * axes.eigenvalues()[2] ? along[k] / moment : 0.0;
  }
  return axes.eigenvectors() * along;
}
}  // namespace

/** Calls visit(row, tissue) for the nodes of a group of tissues that have mass; others are in no
 * tet. */
template <typename Visit>
void Scene::Impl::forEachNodeOf(std::size_t group, const Visit& visit) const
{
  for (std::size_t k = group; k < tissues_.size(); ++k)
  {
    const Index first = tissues_[k].first_node;
    for (Index i = first; group_[k] == group && i < first + tissues_[k].node_count; ++i)
    {
      if (masses_[i] > 0.0)
      {
        visit(i, k);
      }
    }
  }
}

/** Finds groups of tissues that touch each other, and which of them something outside holds. */
void Scene::Impl::findGroups()
{
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    group_[k] = k;
    held_[k] = tissue_info_[k].fixed_nodes.empty() ? 0 : 1;
  }
  for (const MovedNodes& moved : moved_)
  {
    held_[moved.tissue] = 1;
  }
  for (const Attachment& attached : attachments_)
  {
    held_[attached.tissue] = 1;
  }
  for (const Contact& contact : contacts_)
  {
    if (sleeps(contact) || !contact.term->active())
    {
      continue;
    }
    if (contact.with_tissue == nullptr)
    {
      held_[contact.tissue] = 1;
      continue;
    }
    const std::size_t a = group_[contact.tissue], b = group_[contact.other];
    std::replace(group_.begin(), group_.end(), std::max(a, b), std::min(a, b));
  }
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    held_[group_[k]] |= held_[k];
  }
}

Vec3 Scene::Impl::centreOf(std::size_t group, const Points& x) const
{
  double mass = 0.0;
  Vec3 centre = Vec3::Zero();
  forEachNodeOf(group, [&](Index i, std::size_t) {
    mass += masses_[i];
    centre += masses_[i] * x[i];
  });
  return centre / mass;
}

Scene::Impl::Motion Scene::Impl::motionOf(std::size_t group, const Points& x) const
{
  Motion motion;
  forEachNodeOf(group, [&](Index i, std::size_t) {
    motion.mass += masses_[i];
    motion.centre += masses_[i] * x[i];
    motion.velocity += masses_[i] * v_[i];
  });
  motion.centre /= motion.mass;
  motion.velocity /= motion.mass;
  forEachNodeOf(group, [&](Index i, std::size_t) {
    motion.spin += masses_[i] * (x[i] - motion.centre).cross(v_[i] - motion.velocity);
  });
  return motion;
}

/** Moments of inertia about a group's centre, kg m^2. */
Mat3 Scene::Impl::inertiaOf(std::size_t group, const Vec3& centre) const
{
  Vec3 squares = Vec3::Zero(), products = Vec3::Zero();
  forEachNodeOf(group, [&](Index i, std::size_t) {
    const Vec3 arm = x_[i] - centre;
    squares += masses_[i] * arm.cwiseProduct(arm);
    products += masses_[i] * Vec3(arm.y() * arm.z(), arm.z() * arm.x(), arm.x() * arm.y());
  });
  Mat3 inertia;
  inertia << squares.y() + squares.z(), -products.z(), -products.y(),  //
      -products.z(), squares.z() + squares.x(), -products.x(),         //
      -products.y(), -products.x(), squares.x() + squares.y();
  return inertia;
}

/** Where the momentum of a free group that began like this has its centre at the end, m. */
Vec3 Scene::Impl::endOf(std::size_t group, const Motion& start, double h) const
{
  const double fallen = config_.solver.stepper == Stepper::bdf2 ? 0.5 : 1.0;
  const Vec3 flown = h * start.velocity + fallen * h * h * config_.gravity_m_per_s2;
  if (drag_ == nullptr)
  {
    return start.centre + flown;
  }
  // M miss = M (flown - way) - h sum c (way of the node + miss)
  const Vec3 reached = centreOf(group, x_);
  Vec3 dragged = Vec3::Zero();
  double heavier = start.mass;
  forEachNodeOf(group, [&](Index i, std::size_t) {
    dragged += h * drags_[i] * (x_[i] - before_[i]);
    heavier += h * drags_[i];
  });
  return reached + (start.mass * (flown - (reached - start.centre)) - dragged) / heavier;
}

/**
 * Takes the velocities of a step of length h that went from before_ to x_.
 *
 * Of bodies that nothing outside holds, momentum changes by gravity and drag alone, and spin by
 * drag. The first is what the minimiser would have, and is met however far from it the minimisation
 * stopped: moving all as one changes no other force. The second implicit Euler loses: its velocity
 * is that of the chord from before_ to x_. It is turned on by half the step's rotation to the end
 * of the step, and given the spin that is missing. bdf2 has the velocity of the step's end, and
 * falls as far as bodies do; with drag its bodies keep the motion the minimiser gives them.
 */
void Scene::Impl::takeVelocities(double h)
{
  findGroups();
  const auto isFree = [&](std::size_t k) {
    const bool dragged = drag_ != nullptr && config_.solver.stepper == Stepper::bdf2;
    return group_[k] == k && held_[k] == 0 && asleep_[k] == 0 && !dragged;
  };
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (isFree(k))
    {
      goal_[k] = motionOf(k, before_);
      goal_[k].centre = endOf(k, goal_[k], h);
      goal_[k].velocity += h * config_.gravity_m_per_s2;
      const Vec3 off = goal_[k].centre - centreOf(k, x_);
      forEachNodeOf(k, [&](Index i, std::size_t) { x_[i] += off; });
    }
  }
  const StepStart start = startOfPart();
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const StepFormula& formula = formula_[k];
    const Index end = tissues_[k].first_node + tissues_[k].node_count;
    for (Index i = tissues_[k].first_node; i < end; ++i)
    {
      const Vec3 v = (x_[i] - start.position(i, formula)) / formula.effective_s;
      acceleration_[i] = (v - start.velocity(i, formula)) / formula.effective_s;
      v_last_[i] = v_[i];
      v_[i] = v;
    }
  }
  x_last_.swap(before_);
  last_h_ = h;
  for (Contact& contact : contacts_)
  {
    if (!sleeps(contact))
    {
      contact.last_force.swap(contact.force);
    }
  }
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (isFree(k))
    {
      keepMotion(k, h);
    }
  }
}

/** Gives a free group the motion it should have. */
void Scene::Impl::keepMotion(std::size_t group, double h)
{
  const Motion found = motionOf(group, x_);
  if (drag_ != nullptr)
  {
    forEachNodeOf(group, [&](Index i, std::size_t) {
      goal_[group].spin -= h * drags_[i] * (x_[i] - found.centre).cross(v_[i]);
    });
  }
  const Mat3 inertia = inertiaOf(group, found.centre);
  const Vec3 turning = angularVelocity(inertia, found.spin);
  const double angle = 0.5 * h * turning.norm();
  const Mat3 on = angle > 0.0 ? Eigen::AngleAxisd(angle, turning.normalized()).toRotationMatrix()
                              : Mat3::Identity();
  const Motion& goal = goal_[group];
  // The chord of implicit Euler has the right mean by now.
  const Vec3 missed = config_.solver.stepper == Stepper::bdf2 ? Vec3(goal.velocity - found.velocity)
                                                              : Vec3(Vec3::Zero());
  forEachNodeOf(group, [&](Index i, std::size_t tissue) {
    const Vec3 v = v_[i] - found.velocity;
    v_[i] = found.velocity + missed + (formula_[tissue].carried > 0.0 ? v : on * v);
    acceleration_[i] += missed / formula_[tissue].effective_s;
  });
  const Vec3 missing = angularVelocity(inertia, goal.spin - motionOf(group, x_).spin);
  forEachNodeOf(group, [&](Index i, std::size_t) { v_[i] += missing.cross(x_[i] - found.centre); });
}

}  // namespace soft_tissue
