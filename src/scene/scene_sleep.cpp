#include <algorithm>
#include <numeric>

#include "scene_impl.h"

namespace soft_tissue
{
namespace
{
/** Key frames that move nodes by less than this, m and shares of a turn, leave them where they are.
 */
constexpr double kUnmoved = 1e-12;

double largestNorm(const Vec3* begin, Index count)
{
  double squared = 0.0;
  for (Index i = 0; i < count; ++i)
  {
    squared = std::max(squared, begin[i].squaredNorm());
  }
  return std::sqrt(squared);
}
}  // namespace

std::size_t Scene::Impl::sleepers() const
{
  return static_cast<std::size_t>(std::count(asleep_.begin(), asleep_.end(), 1));
}

/** Whether a contact is left out: nothing awake is near a tissue that sleeps, or it would not. */
bool Scene::Impl::sleeps(const Contact& contact) const
{
  return asleep_[contact.tissue] != 0 ||
         (contact.with_tissue != nullptr && asleep_[contact.other] != 0);
}

/** Gives each tissue that is awake the box it stays in during a step, as far as is known. */
void Scene::Impl::findReaches()
{
  const double h = config_.time_step_s;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    Tissue& tissue = tissues_[k];
    if (asleep_[k] != 0)
    {
      continue;
    }
    tissue.reach = Box3();
    std::for_each_n(x_.begin() + tissue.first_node, tissue.node_count,
                    [&](const Vec3& p) { tissue.reach.extend(p); });
    const double speed = largestNorm(v_.data() + tissue.first_node, tissue.node_count);
    const double acceleration =
        largestNorm(acceleration_.data() + tissue.first_node, tissue.node_count);
    tissue.reach.grow(h * speed + h * h * acceleration);
  }
}

/** Whether both bodies of a contact are within its margin in this step. */
bool Scene::Impl::areNear(const Contact& contact) const
{
  const Tissue& tissue = tissues_[contact.tissue];
  Box3 reach = tissue.reach;
  reach.grow(tissue.short_edge);
  if (contact.with_tissue != nullptr)
  {
    reach.grow(tissues_[contact.other].short_edge);
    return reach.overlaps(tissues_[contact.other].reach);
  }
  if (contact.with_tool != nullptr)
  {
    const ToolPart& part = partOf(contact);
    Box3 swept = transformed(part.X_WP, part.shape.bounds());
    swept.extend(transformed(part.X_WP_goal, part.shape.bounds()));
    return reach.overlaps(swept);
  }
  return false;  // those of obstacles that change are woken as they do
}

/** Whether something outside moves a tissue in this step: its key frames, a tool near it or one
 * that it is tied to. */
bool Scene::Impl::isDriven(std::size_t k) const
{
  const double end_s = report_.time_s + config_.time_step_s;
  const bool moved = std::any_of(moved_.begin(), moved_.end(), [&](const MovedNodes& nodes) {
    return nodes.tissue == k &&
           !nodes.track.at(end_s).isApprox(nodes.track.at(report_.time_s), kUnmoved);
  });
  const bool pulled =
      std::any_of(attachments_.begin(), attachments_.end(), [&](const Attachment& attached) {
        return attached.tissue == k && isMoving(tools_[attached.tool].parts[attached.part]);
      });
  return moved || pulled ||
         std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& contact) {
           return contact.tissue == k && contact.with_tool != nullptr &&
                  isMoving(partOf(contact)) && areNear(contact);
         });
}

/** Wakes an island; setSleepers() has to follow. */
void Scene::Impl::wake(std::size_t island)
{
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (asleep_[k] != 0 && island_[k] == island)
    {
      asleep_[k] = 0;
      quiet_s_[k] = 0.0;
    }
  }
}

/** Wakes whole islands of tissues that something moves, or that something awake has come near to.
 */
void Scene::Impl::wakeUp()
{
  if (sleepers() == 0)
  {
    return;
  }
  findReaches();
  const std::size_t sleeping = sleepers();
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (asleep_[k] != 0 && isDriven(k))
    {
      wake(island_[k]);
    }
  }
  for (bool again = true; again;)
  {
    again = false;
    for (const Contact& contact : contacts_)
    {
      if (contact.with_tissue != nullptr && asleep_[contact.tissue] != asleep_[contact.other] &&
          areNear(contact))
      {
        wake(island_[asleep_[contact.tissue] != 0 ? contact.tissue : contact.other]);
        again = true;
      }
    }
  }
  if (sleepers() < sleeping)
  {
    setSleepers();
  }
}

/** Whether a tissue has hardly moved in the step that ends, and nothing is about to move it. */
bool Scene::Impl::isQuiet(std::size_t k) const
{
  const Tissue& tissue = tissues_[k];
  const SleepConfig& limits = *config_.solver.sleep;
  const bool eases = std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& contact) {
    return contact.allowance_m > 0.0 &&
           (contact.tissue == k || (contact.with_tissue != nullptr && contact.other == k));
  });
  return !eases && !isDriven(k) &&
         largestNorm(v_.data() + tissue.first_node, tissue.node_count) <= limits.speed_m_per_s &&
         largestNorm(acceleration_.data() + tissue.first_node, tissue.node_count) <=
             limits.acceleration_m_per_s2;
}

/** Puts islands to sleep all of which has been quiet for long enough. A step that failed or ended
 * unfinished tells nothing of rest. */
void Scene::Impl::fallAsleep()
{
  if (!config_.solver.sleep || sleepers() == tissues_.size())
  {
    return;
  }
  const bool tells = !report_.held && (report_.converged || report_.residual <= kFailedResidual);
  const auto rests = [&](std::size_t k) {
    return asleep_[k] != 0 || (quiet_s_[k] > 0.0 && quiet_s_[k] >= config_.solver.sleep->after_s);
  };
  bool any = false;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    if (asleep_[k] == 0)
    {
      quiet_s_[k] = tells && isQuiet(k) ? quiet_s_[k] + config_.time_step_s : 0.0;
      any = any || rests(k);
    }
  }
  if (!any)
  {
    return;
  }
  findReaches();
  std::vector<std::size_t>& island = islands_found_;
  std::iota(island.begin(), island.end(), 0);
  for (const Contact& contact : contacts_)
  {
    if (contact.with_tissue != nullptr && areNear(contact))
    {
      const std::size_t a = island[contact.tissue], b = island[contact.other];
      std::replace(island.begin(), island.end(), std::max(a, b), std::min(a, b));
    }
  }
  bool fell = false;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    bool all = true, awake = false;
    for (std::size_t j = k; j < tissues_.size(); ++j)
    {
      all = all && (island[j] != k || rests(j));
      awake = awake || (island[j] == k && asleep_[j] == 0);
    }
    for (std::size_t j = k; awake && all && j < tissues_.size(); ++j)
    {
      if (island[j] == k)
      {
        asleep_[j] = 1;
        island_[j] = k;
        fell = true;
      }
    }
  }
  if (fell)
  {
    setSleepers();
  }
}

/** Leaves what sleeps out of the terms of inertia and gravity and out of the solver, at rest now
 * and before. */
void Scene::Impl::setSleepers()
{
  std::vector<NodeRange> awake;
  for (std::size_t k = 0; k < tissues_.size(); ++k)
  {
    const Index begin = tissues_[k].first_node, end = begin + tissues_[k].node_count;
    if (asleep_[k] != 0)
    {
      std::fill(v_.begin() + begin, v_.begin() + end, Vec3::Zero());
      std::fill(acceleration_.begin() + begin, acceleration_.begin() + end, Vec3::Zero());
      std::copy(x_.begin() + begin, x_.begin() + end, x_last_.begin() + begin);
      std::fill(v_last_.begin() + begin, v_last_.begin() + end, Vec3::Zero());
    }
    else if (!awake.empty() && awake.back().end == begin)
    {
      awake.back().end = end;
    }
    else
    {
      awake.push_back({begin, end});
    }
  }
  inertia_->setNodes(awake);
  gravity_->setNodes(awake);
  if (drag_ != nullptr)
  {
    drag_->setNodes(awake);
  }
  makeSolver();
}

}  // namespace soft_tissue
