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

/** Calls visit(row) for the nodes of a group of tissues that have mass; others are in no tet. */
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
        visit(i);
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
  for (const Contact& contact : contacts_)
  {
    if (!contact.term->active())
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

Scene::Impl::Motion Scene::Impl::motionOf(std::size_t group, const Points& x) const
{
  Motion motion;
  forEachNodeOf(group, [&](Index i) {
    motion.mass += masses_[i];
    motion.centre += masses_[i] * x[i];
    motion.velocity += masses_[i] * v_[i];
  });
  motion.centre /= motion.mass;
  motion.velocity /= motion.mass;
  forEachNodeOf(group, [&](Index i) {
    const Vec3 arm = x[i] - motion.centre;
    motion.spin += masses_[i] * arm.cross(v_[i] - motion.velocity);
    motion.inertia += masses_[i] * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  });
  return motion;
}

/** How far a free group that began like this is from where its momentum has it at the end, m. */
Vec3 Scene::Impl::missOf(std::size_t group, const Motion& start, double h) const
{
  const Vec3 reached = motionOf(group, x_).centre;
  const Vec3 flown = h * start.velocity + h * h * config_.gravity_m_per_s2;
  if (drag_ == nullptr)
  {
    return start.centre + flown - reached;
  }
  // M miss = M (flown - way) - h sum c (way of the node + miss)
  Vec3 dragged = Vec3::Zero();
  double heavier = start.mass;
  forEachNodeOf(group, [&](Index i) {
    dragged += h * drags_[i] * (x_[i] - before_[i]);
    heavier += h * drags_[i];
  });
  return (start.mass * (flown - (reached - start.centre)) - dragged) / heavier;
}

/**
 * Takes the velocities of a step of length h that went from before_ to x_.
 *
 * Of bodies that nothing outside holds, momentum changes by gravity and drag alone, and spin by
 * drag. The first is what the minimiser would have, and is met however far from it the minimisation
 * stopped: moving all as one changes no other force. The second implicit Euler loses: its velocity
 * is that of the chord from before_ to x_. It is turned on by half the step's rotation to the end
 * of the step, and given the spin that is missing.
 */
void Scene::Impl::takeVelocities(double h)
{
  findGroups();
  const auto isFree = [&](std::size_t k) { return group_[k] == k && held_[k] == 0; };
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (isFree(k))
    {
      const Motion start = motionOf(k, before_);
      spin_[k] = start.spin;
      const Vec3 off = missOf(k, start, h);
      forEachNodeOf(k, [&](Index i) { x_[i] += off; });
    }
  }
  for (std::size_t i = 0; i < x_.size(); ++i)
  {
    const Vec3 v = (x_[i] - before_[i]) / h;
    acceleration_[i] = (v - v_[i]) / h;
    v_[i] = v;
  }
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (isFree(k))
    {
      keepSpin(k, h);
    }
  }
}

void Scene::Impl::keepSpin(std::size_t group, double h)
{
  const Motion chord = motionOf(group, x_);
  if (drag_ != nullptr)
  {
    forEachNodeOf(group, [&](Index i) {
      spin_[group] -= h * drags_[i] * (x_[i] - chord.centre).cross(v_[i]);
    });
  }
  const Vec3 turning = angularVelocity(chord.inertia, chord.spin);
  const double angle = 0.5 * h * turning.norm();
  const Mat3 on = angle > 0.0 ? Eigen::AngleAxisd(angle, turning.normalized()).toRotationMatrix()
                              : Mat3::Identity();
  forEachNodeOf(group, [&](Index i) { v_[i] = chord.velocity + on * (v_[i] - chord.velocity); });
  const Motion turned = motionOf(group, x_);
  const Vec3 missing = angularVelocity(turned.inertia, spin_[group] - turned.spin);
  forEachNodeOf(group, [&](Index i) { v_[i] += missing.cross(x_[i] - turned.centre); });
}

}  // namespace soft_tissue
