#include <Eigen/Dense>
#include <algorithm>

#include "scene_impl.h"
#include "soft_tissue_sim/base/union_find.h"

namespace soft_tissue
{
namespace
{
/** Nodes without mass, which are in no tet, are none of them. */
template <typename Visit>
void forEachNode(const std::vector<NodeRange>& ranges, const std::vector<double>& masses,
                 const Visit& visit)
{
  for (const NodeRange& range : ranges)
  {
    for (Index i = range.first; i < range.first + range.count; ++i)
    {
      if (masses[i] > 0.0)
      {
        visit(i);
      }
    }
  }
}

/** How some nodes move as a whole. */
struct Motion
{
  double mass = 0.0;
  Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();     ///< angular momentum about the centre
  Mat3 inertia = Mat3::Zero();  ///< moments of inertia about the centre
};

Motion motionOf(const std::vector<NodeRange>& ranges, const std::vector<double>& masses,
                const Points& x, const Points& v)
{
  Motion motion;
  forEachNode(ranges, masses, [&](Index i) {
    motion.mass += masses[i];
    motion.centre += masses[i] * x[i];
    motion.velocity += masses[i] * v[i];
  });
  motion.centre /= motion.mass;
  motion.velocity /= motion.mass;
  forEachNode(ranges, masses, [&](Index i) {
    const Vec3 arm = x[i] - motion.centre;
    motion.spin += masses[i] * arm.cross(v[i] - motion.velocity);
    motion.inertia += masses[i] * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  });
  return motion;
}

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

/** Groups of tissues that touch each other, or one alone, which nothing outside holds. */
std::vector<std::vector<NodeRange>> Scene::Impl::freeBodies()
{
  UnionFind groups(tissues_.size());
  std::vector<char> held(tissues_.size(), 0);
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    held[k] = tissue_info_[k].fixed_nodes.empty() ? 0 : 1;
  }
  for (const MovedNodes& moved : moved_)
  {
    held[moved.tissue] = 1;
  }
  for (const Contact& contact : contacts_)
  {
    if (contact.term->active() && contact.with_tissue == nullptr)
    {
      held[contact.tissue] = 1;
    }
    else if (contact.term->active())
    {
      groups.join(static_cast<Index>(contact.tissue), static_cast<Index>(contact.other));
    }
  }
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    held[groups.find(static_cast<Index>(k))] |= held[k];
  }
  std::vector<std::vector<NodeRange>> free(tissues_.size());
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const Index group = groups.find(static_cast<Index>(k));
    if (held[group] == 0)
    {
      free[group].push_back({tissues_[k].first_node, tissues_[k].node_count});
    }
  }
  free.erase(std::remove_if(free.begin(), free.end(), [](const auto& g) { return g.empty(); }),
             free.end());
  return free;
}

/**
 * Takes the velocities of a step of length h that went from before_ to x_.
 *
 * Of bodies that nothing outside holds, momentum changes by gravity alone, and spin not at all. The
 * first is what the minimiser would have, and is met however far from it the minimisation stopped:
 * moving all as one changes no other force. The second implicit Euler loses: its velocity is that
 * of the chord from before_ to x_. It is turned on by half the step's rotation to the end of the
 * step, and given the spin that is missing.
 */
void Scene::Impl::takeVelocities(double h)
{
  const std::vector<std::vector<NodeRange>> free = freeBodies();
  std::vector<Motion> start;
  for (const std::vector<NodeRange>& ranges : free)
  {
    start.push_back(motionOf(ranges, masses_, before_, v_));
    const Vec3 centre =
        start.back().centre + h * start.back().velocity + h * h * config_.gravity_m_per_s2;
    const Vec3 off = centre - motionOf(ranges, masses_, x_, v_).centre;
    forEachNode(ranges, masses_, [&](Index i) { x_[i] += off; });
  }
  for (std::size_t i = 0; i < x_.size(); ++i)
  {
    const Vec3 v = (x_[i] - before_[i]) / h;
    acceleration_[i] = (v - v_[i]) / h;
    v_[i] = v;
  }
  for (std::size_t k = 0; k < free.size(); ++k)
  {
    keepSpin(free[k], start[k].spin, h);
  }
}

void Scene::Impl::keepSpin(const std::vector<NodeRange>& ranges, const Vec3& spin, double h)
{
  const Motion chord = motionOf(ranges, masses_, x_, v_);
  const Vec3 turning = angularVelocity(chord.inertia, chord.spin);
  const double angle = 0.5 * h * turning.norm();
  const Mat3 on = angle > 0.0 ? Eigen::AngleAxisd(angle, turning.normalized()).toRotationMatrix()
                              : Mat3::Identity();
  forEachNode(ranges, masses_,
              [&](Index i) { v_[i] = chord.velocity + on * (v_[i] - chord.velocity); });
  const Motion turned = motionOf(ranges, masses_, x_, v_);
  const Vec3 missing = angularVelocity(turned.inertia, spin - turned.spin);
  forEachNode(ranges, masses_, [&](Index i) { v_[i] += missing.cross(x_[i] - turned.centre); });
}

}  // namespace soft_tissue
