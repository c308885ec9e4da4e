#include <algorithm>
#include <cmath>
#include <limits>

#include "scene_impl.h"

namespace soft_tissue
{
namespace
{
/** How far two bodies may move past each other in one part of a step, in Contact::size_m. A
 * membrane must not get as far as the middle of the other, where it finds either way out. */
constexpr double kMostMotion = 1.0, kMostMotionOfMembranes = 0.5;
constexpr double kMostParts = 64.0;

// Where contact is too deep it is made stiffer, in proportion and a little more, and balance is
// found anew; in later steps it slowly gets as soft as it was.
constexpr double kAhead = 1.2, kLeastStiffening = 1.3, kMostStiffening = 4.0;
constexpr double kRelaxed = 0.98;

/** How far a corner of a box goes from one pose to another, m. */
double farthestMotion(const Box3& box, const Pose& from, const Pose& to)
{
  double farthest = 0.0;
  for (int k = 0; k < 8; ++k)
  {
    const Vec3 corner((k & 1 ? box.max : box.min).x(), (k & 2 ? box.max : box.min).y(),
                      (k & 4 ? box.max : box.min).z());
    farthest = std::max(farthest, (to * corner - from * corner).norm());
  }
  return farthest;
}

Vec3 mean(const Vec3* begin, Index count)
{
  Vec3 sum = Vec3::Zero();
  for (Index i = 0; i < count; ++i)
  {
    sum += begin[i];
  }
  return sum / count;
}

double farthestFrom(const Vec3& v, const Vec3* begin, Index count)
{
  double squared = 0.0;
  for (Index i = 0; i < count; ++i)
  {
    squared = std::max(squared, (begin[i] - v).squaredNorm());
  }
  return std::sqrt(squared);
}

ContactPoint pointOf(const ContactSample& sample, std::size_t tissue)
{
  return {sample.position, sample.normal(),       sample.depth,
          sample.area,     sample.forceOnFirst(), static_cast<Index>(tissue),
          sample.host};
}

ContactPoint pointOf(const FrictionForce& force, std::size_t tissue)
{
  return {force.position, force.normal, 0.0, 0.0, force.on_first, static_cast<Index>(tissue), -1};
}

/** The wrenches that the contacts of a tool make, on its parts and altogether. */
void addUp(const Vec3& origin_W, ToolState& state)
{
  state.wrench_W = Wrench();
  for (ToolPartState& part : state.parts)
  {
    part.wrench_W = Wrench();
  }
  for (const ContactPoint& point : state.contacts)
  {
    const Vec3 torque = (point.position_W - origin_W).cross(point.force_W);
    for (Wrench* sum : {&state.wrench_W, &state.parts[point.part].wrench_W})
    {
      sum->force += point.force_W;
      sum->torque += torque;
    }
  }
}
}  // namespace

/** In how many parts the step has to be taken so that no body gets deeper into another in one of
 * them than it finds the way out of. */
int Scene::Impl::partsOfStep() const
{
  double parts = motionOfAttached();
  for (const Contact& contact : contacts_)
  {
    if (sleeps(contact))
    {
      continue;
    }
    const double moved = contact.with_tool != nullptr       ? motionOfTool(contact)
                         : contact.with_obstacle != nullptr ? motionInObstacle(contact)
                                                            : motionOfTissues(contact);
    parts = std::max(parts, moved / mostMotion(contact));
  }
  return static_cast<int>(std::ceil(std::min(parts, kMostParts)));
}

/** How far parts of tools that tissue is tied to move in this step, in the radius of a ball inside
 * them; at least 1. */
double Scene::Impl::motionOfAttached() const
{
  double most = 1.0;
  for (const Tool& tool : tools_)
  {
    for (const ToolPart& part : tool.parts)
    {
      if (part.attached > 0)
      {
        most = std::max(most, farthestMotion(part.shape.bounds(), part.X_WP, part.X_WP_goal) /
                                  (kMostMotion * part.shape.innerRadius()));
      }
    }
  }
  return most;
}

double Scene::Impl::mostMotion(const Contact& contact) const
{
  const bool thin = tissue_info_[contact.tissue].isMembrane();
  return (thin ? kMostMotionOfMembranes : kMostMotion) * contact.size_m;
}

/** How far a tissue may move in this step past what drifts, m, and the box it stays in. */
double Scene::Impl::motionOfTissue(std::size_t index, const Vec3& drift, Box3& reach) const
{
  const Tissue& tissue = tissues_[index];
  const auto first = x_.begin() + tissue.first_node;
  const double moved =
      config_.time_step_s * farthestFrom(drift, v_.data() + tissue.first_node, tissue.node_count);
  std::for_each_n(first, tissue.node_count, [&](const Vec3& p) { reach.extend(p); });
  reach.grow(moved);
  return moved;
}

/** How far a tool and a tissue move past each other in this step, m; 0 where they don't meet. */
double Scene::Impl::motionOfTool(const Contact& contact) const
{
  const ToolPart& part = partOf(contact);
  Box3 tissue;
  const double own = motionOfTissue(contact.tissue, Vec3::Zero(), tissue);
  const double moved = farthestMotion(part.shape.bounds(), part.X_WP, part.X_WP_goal) + own;
  if (!(moved > mostMotion(contact)))
  {
    return 0.0;
  }
  Box3 reach = transformed(part.X_WP, part.shape.bounds());
  reach.extend(transformed(part.X_WP_goal, part.shape.bounds()));
  reach.grow(own);
  const Vec3* x = x_.data() + tissues_[contact.tissue].first_node;
  const auto& triangles = tissue_info_[contact.tissue].surface.triangles;
  const bool near = std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    Box3 box;
    std::for_each(t.begin(), t.end(), [&](Index node) { box.extend(x[node]); });
    return box.overlaps(reach);
  });
  return near ? moved : 0.0;
}

/** The same of two tissues. What both do together does not count. */
double Scene::Impl::motionOfTissues(const Contact& contact) const
{
  const Tissue& b = tissues_[contact.other];
  const Vec3 drift = mean(v_.data() + b.first_node, b.node_count);
  Box3 box_a, box_b;
  const double moved =
      motionOfTissue(contact.tissue, drift, box_a) + motionOfTissue(contact.other, drift, box_b);
  return moved > mostMotion(contact) && box_a.overlaps(box_b) ? moved : 0.0;
}

/** Contacts take the state that the part [from, to] of the step starts with; those that can touch
 * become terms. */
void Scene::Impl::beginContacts(double from, double to)
{
  for (const Contact& contact : contacts_)
  {
    if (sleeps(contact))
    {
      continue;
    }
    contact.term->setStep(isDynamic() ? (to - from) * config_.time_step_s
                                      : std::numeric_limits<double>::infinity());
    contact.term->setStiffening(std::max(1.0, kRelaxed * contact.term->stiffening()));
    if (contact.with_tool != nullptr)
    {
      const ToolPart& part = partOf(contact);
      contact.with_tool->beginStep(x_, partAt(contact.other, part, from),
                                   partAt(contact.other, part, to), contact.refresh);
    }
    else if (contact.with_obstacle != nullptr)
    {
      contact.with_obstacle->beginStep(x_);
    }
    else
    {
      contact.with_tissue->beginStep(x_, extrapolated_, contact.refresh);
    }
    if (contact.term->active())
    {
      terms_.push_back(contact.term.get());
    }
  }
}

/** Makes contacts stiffer that are deeper than they may be. @return whether there were any */
bool Scene::Impl::stiffenWhereTooDeep()
{
  bool any = false;
  for (const Contact& contact : contacts_)
  {
    if (!contact.max_penetration_m || sleeps(contact) || !contact.term->active())
    {
      continue;
    }
    const double share = contact.term->deepestExcess(x_) / *contact.max_penetration_m;
    if (share > 1.0)
    {
      contact.term->setStiffening(contact.term->stiffening() *
                                  std::clamp(kAhead * share, kLeastStiffening, kMostStiffening));
      any = true;
    }
  }
  if (any)
  {
    newton_->forgetMatrix();
  }
  return any;
}

/** Where its contact points are read out. */
std::vector<ContactPoint>& Scene::Impl::pointsOf(const Contact& contact)
{
  if (contact.with_tissue != nullptr)
  {
    return pairs_[contact.pair].contacts;
  }
  return contact.with_tool != nullptr ? tools_[contact.other].state.contacts
                                      : obstacles_[contact.other].state.contacts;
}

void Scene::Impl::collectContacts()
{
  showObstacles();
  for (Tool& tool : tools_)
  {
    tool.state.contacts.clear();
  }
  for (Obstacle& obstacle : obstacles_)
  {
    obstacle.state.contacts.clear();
  }
  for (TissuePairState& pair : pairs_)
  {
    pair.contacts.clear();
  }
  for (const Contact& contact : contacts_)
  {
    if (!contact.term->active())
    {
      continue;
    }
    const bool rigid = contact.with_tissue == nullptr;
    if (!rigid && asleep_[contact.tissue] != asleep_[contact.other])
    {
      continue;  // nothing awake is near
    }
    std::vector<ContactPoint>& points = pointsOf(contact);
    const std::size_t before = points.size();
    for (const ContactSample& sample : contact.term->samples(x_))
    {
      const bool in_first = !rigid && sample.side < 0;
      points.push_back(pointOf(sample, rigid || in_first ? contact.tissue : contact.other));
      report_.max_penetration_m = std::max(report_.max_penetration_m, sample.depth);
      ++report_.contacts;
    }
    for (const FrictionForce& force : contact.term->frictionForces(x_))
    {
      points.push_back(pointOf(force, contact.tissue));
    }
    for (std::size_t i = before; contact.with_tool != nullptr && i < points.size(); ++i)
    {
      points[i].part = static_cast<Index>(contact.part);
    }
  }
  collectAttachments();
  for (Tool& tool : tools_)
  {
    addUp(tool.X_WT.translation(), tool.state);
  }
}

}  // namespace soft_tissue
