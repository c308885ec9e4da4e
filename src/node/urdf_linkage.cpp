#include "urdf_linkage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Coordinate;
using soft_tissue::Error;
using soft_tissue::JointKind;
using soft_tissue::Linkage;
using soft_tissue::Vec3;

/** A joint's value is factor times that of another, which mimics none, plus offset. */
struct Follows
{
  const urdf::Joint* leader = nullptr;
  double factor = 1.0, offset = 0.0;
};

JointKind kindOf(const urdf::Joint& joint)
{
  switch (joint.type)
  {
    case urdf::Joint::FIXED:
      return JointKind::fixed;
    case urdf::Joint::REVOLUTE:
    case urdf::Joint::CONTINUOUS:
      return JointKind::turning;
    case urdf::Joint::PRISMATIC:
      return JointKind::sliding;
    default:
      throw Error("joint '" + joint.name +
                  "' must be fixed, revolute, continuous or prismatic to be part of a tool");
  }
}

Follows leaderOf(const urdf::ModelInterface& model, const urdf::Joint& joint)
{
  Follows follows;
  follows.leader = &joint;
  for (std::size_t met = 0; follows.leader->mimic; ++met)
  {
    const urdf::JointMimic& mimic = *follows.leader->mimic;
    const urdf::JointConstSharedPtr next = model.getJoint(mimic.joint_name);
    if (!next || met == model.joints_.size() || kindOf(*next) == JointKind::fixed)
    {
      throw Error("joint '" + follows.leader->name + "' mimics '" + mimic.joint_name + "', which " +
                  (!next                         ? "does not exist"
                   : met == model.joints_.size() ? "mimics it in turn"
                                                 : "does not move"));
    }
    follows.offset += follows.factor * mimic.offset;
    follows.factor *= mimic.multiplier;
    follows.leader = next.get();
  }
  return follows;
}

/** Narrows a coordinate's limits to those that keep a joint which follows it within its own. */
void limit(const urdf::Joint& joint, const Follows& follows, Coordinate& coordinate)
{
  const double factor = follows.factor;
  if (!joint.limits || factor == 0.0)
  {
    return;
  }
  if (joint.limits->velocity > 0.0)  // zero is what many files have that don't know
  {
    coordinate.max_speed =
        std::min(coordinate.max_speed, joint.limits->velocity / std::abs(factor));
  }
  if (joint.type != urdf::Joint::CONTINUOUS)
  {
    double lower = (joint.limits->lower - follows.offset) / factor;
    double upper = (joint.limits->upper - follows.offset) / factor;
    if (factor < 0.0)
    {
      std::swap(lower, upper);
    }
    coordinate.lower = std::max(coordinate.lower, lower);
    coordinate.upper = std::min(coordinate.upper, upper);
  }
}

Coordinate coordinateOf(const urdf::ModelInterface& model, const urdf::Joint& leader)
{
  Coordinate coordinate;
  coordinate.name = leader.name;
  for (const auto& [name, joint] : model.joints_)
  {
    if (joint->type == urdf::Joint::FIXED)
    {
      continue;
    }
    const Follows follows =
        joint->mimic || joint->name == leader.name ? leaderOf(model, *joint) : Follows();
    if (follows.leader == &leader)
    {
      limit(*joint, follows, coordinate);
    }
  }
  return coordinate;
}

soft_tissue::Link linkOf(const urdf::Link& link, const Linkage& linkage)
{
  const urdf::Joint& joint = *link.parent_joint;
  soft_tissue::Link made;
  made.name = link.name;
  made.parent = linkage.find(link.getParent()->name);
  made.X_PJ = poseConfig(joint.parent_to_joint_origin_transform).toPose();
  made.kind = kindOf(joint);
  const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (made.kind != JointKind::fixed)
  {
    if (!(axis.norm() > 0.0))
    {
      throw Error("joint '" + joint.name + "' has an axis of length 0");
    }
    made.axis_J = axis.normalized();
  }
  return made;
}

/** The links from the root to one of a name. */
std::vector<urdf::LinkConstSharedPtr> wayTo(const urdf::ModelInterface& model,
                                            const std::string& name)
{
  std::vector<urdf::LinkConstSharedPtr> way;
  for (urdf::LinkConstSharedPtr link = model.getLink(name); link; link = link->getParent())
  {
    way.insert(way.begin(), link);
  }
  return way;
}
}  // namespace

soft_tissue::PoseConfig poseConfig(const urdf::Pose& pose)
{
  soft_tissue::PoseConfig config;
  config.position_m = Vec3(pose.position.x, pose.position.y, pose.position.z);
  Vec3& rpy = config.rotation_rpy_rad;
  pose.rotation.getRPY(rpy.x(), rpy.y(), rpy.z());
  return config;
}

Linkage urdfLinkage(const urdf::ModelInterface& model, const std::vector<std::string>& links,
                    bool from_root)
{
  std::vector<std::vector<urdf::LinkConstSharedPtr>> ways;
  std::transform(links.begin(), links.end(), std::back_inserter(ways),
                 [&](const std::string& link) { return wayTo(model, link); });
  std::size_t first = 0;  // on all ways
  const auto same = [&](const auto& way) {
    return first + 1 < way.size() && way[first + 1] == ways[0][first + 1];
  };
  while (!from_root && std::all_of(ways.begin(), ways.end(), same))
  {
    ++first;
  }
  Linkage linkage(ways[0][first]->name);
  for (const auto& way : ways)
  {
    for (std::size_t k = first + 1; k < way.size(); ++k)
    {
      if (linkage.find(way[k]->name) < linkage.links().size())
      {
        continue;
      }
      soft_tissue::Link link = linkOf(*way[k], linkage);
      if (link.kind != JointKind::fixed)
      {
        const Follows follows = leaderOf(model, *way[k]->parent_joint);
        link.coordinate = linkage.findCoordinate(follows.leader->name);
        if (link.coordinate == linkage.coordinates().size())
        {
          linkage.add(coordinateOf(model, *follows.leader));
        }
        link.factor = follows.factor;
        link.offset = follows.offset;
      }
      linkage.add(link);
    }
  }
  return linkage;
}

}  // namespace soft_tissue_sim
