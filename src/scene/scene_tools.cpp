#include <algorithm>
#include <sstream>

#include "bodies.h"
#include "scene_impl.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** A value a joint is given by its name. @throws Error for none of the tool's or beyond its limits
 */
void take(const JointValue& given, const Linkage& linkage, const std::string& where,
          JointValues& values)
{
  const std::vector<Coordinate>& joints = linkage.coordinates();
  const std::size_t k = linkage.findCoordinate(given.joint);
  std::ostringstream text;
  if (k == joints.size())
  {
    text << where << ": there is no joint '" << given.joint << "' that moves by itself; there "
         << (joints.empty() ? "is none" : "are");
    std::for_each(joints.begin(), joints.end(),
                  [&](const Coordinate& joint) { text << " " << joint.name; });
    throw Error(text.str());
  }
  if (!(given.value >= joints[k].lower && given.value <= joints[k].upper))
  {
    text << where << "." << given.joint << " = " << given.value << ", must be in ["
         << joints[k].lower << ", " << joints[k].upper << "]";
    throw Error(text.str());
  }
  values[static_cast<Eigen::Index>(k)] = given.value;
}

JointSeries trackOf(const ToolConfig& config, const JointValues& start, const std::string& where)
{
  JointSeries track;
  for (const JointKeyframe& keyframe : config.joint_source.keyframes)
  {
    const std::vector<JointValue>& first = config.joint_source.keyframes[0].values;
    const bool same = std::is_permutation(
        first.begin(), first.end(), keyframe.values.begin(), keyframe.values.end(),
        [](const JointValue& a, const JointValue& b) { return a.joint == b.joint; });
    if (!same)
    {
      throw Error(where + ".joint_source.keyframes must all give the same joints");
    }
    JointValues values = start;
    for (const JointValue& value : keyframe.values)
    {
      take(value, config.linkage, where + ".joint_source.keyframes", values);
    }
    track.times_s.push_back(keyframe.time_s);
    track.samples.push_back(values);
  }
  return track;
}

/** The share of the way from one pose to another that a tool may go in a step. */
double shareOfWay(const ToolConfig& config, const Pose& from, const Pose& to, double step_s)
{
  double share = 1.0;
  if (config.max_speed_m_per_s)
  {
    const double way = (to.translation() - from.translation()).norm();
    share = std::min(share, *config.max_speed_m_per_s * step_s / way);
  }
  if (config.max_turn_rate_rad_per_s)
  {
    const double turn = Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
    share = std::min(share, *config.max_turn_rate_rad_per_s * step_s / turn);
  }
  return share;
}
}  // namespace

JointValues Scene::Impl::initialJoints(std::size_t index) const
{
  const ToolConfig& config = config_.tools[index];
  const auto count = static_cast<Eigen::Index>(config.linkage.coordinates().size());
  const JointValues zero = JointValues::Zero(count);
  JointValues values = config.linkage.within(zero, zero);
  for (const JointValue& value : config.initial_joints)
  {
    take(value, config.linkage, item(config_, "tools", index) + ".initial_joints_rad_or_m", values);
  }
  return values;
}

void Scene::Impl::addTool(std::size_t index)
{
  const ToolConfig& config = config_.tools[index];
  const std::string where = item(config_, "tools", index);
  Tool& tool = tools_.emplace_back();
  ToolInfo info;
  info.name = config.name;
  info.joints = config.linkage.coordinates();
  for (ToolPartModel& model : makeToolParts(config, where))
  {
    SurfaceMesh surface = model.shape.surface(0.5 * model.shape.innerRadius());
    info.parts.push_back(
        {model.name, model.link, {std::move(surface.nodes), std::move(surface.triangles)}});
    ToolPart part;
    part.shape = std::move(model.shape);
    part.link = model.link;
    tool.parts.push_back(std::move(part));
  }
  tool_info_.push_back(std::move(info));
  for (const PoseKeyframe& keyframe : config.pose_source.keyframes)
  {
    tool.track.times_s.push_back(keyframe.time_s);
    tool.track.samples.push_back(keyframe.pose.toPose());
  }
  tool.joint_track = trackOf(config, initialJoints(index), where);
  placeTool(index);
}

/** Where it starts, or starts anew. */
void Scene::Impl::placeTool(std::size_t index)
{
  const ToolConfig& config = config_.tools[index];
  Tool& tool = tools_[index];
  tool.joints_target = initialJoints(index);
  tool.joints = tool.joint_track.empty() ? tool.joints_target : tool.joint_track.at(report_.time_s);
  tool.X_WT_target = config.initial_pose.toPose();
  tool.X_WT = targetOf(index, tool.joints);
  tool.state = ToolState();
  tool.state.parts.resize(tool.parts.size());
  aim(index, report_.time_s);
  arrive(tool);
}

/** Where a tool without key frames shall go, its joints being at these values. */
Pose Scene::Impl::targetOf(std::size_t index, const JointValues& joints) const
{
  const ToolConfig& config = config_.tools[index];
  return config.pose_source.kind == PoseSourceConfig::Kind::base
             ? config.pose_source.base_pose.toPose() * config.linkage.pose(0, config.frame, joints)
             : tools_[index].X_WT_target;
}

/** Chooses where a tool is at the end of a step, from where it is now. */
void Scene::Impl::aim(std::size_t index, double end_s)
{
  const ToolConfig& config = config_.tools[index];
  const Linkage& linkage = config.linkage;
  Tool& tool = tools_[index];
  const double h = config_.time_step_s;
  if (!tool.joint_track.empty())
  {
    tool.joints_goal = tool.joint_track.at(end_s);
  }
  else
  {
    tool.joints_goal = tool.joints_target;
    for (Eigen::Index k = 0; k < tool.joints.size(); ++k)
    {
      const double most = h * linkage.coordinates()[static_cast<std::size_t>(k)].max_speed;
      tool.joints_goal[k] =
          std::clamp(tool.joints_target[k], tool.joints[k] - most, tool.joints[k] + most);
    }
  }
  const Pose target = targetOf(index, tool.joints_goal);
  tool.X_WT_goal = tool.track.empty()
                       ? interpolate(tool.X_WT, target, shareOfWay(config, tool.X_WT, target, h))
                       : tool.track.at(end_s);
  for (ToolPart& part : tool.parts)
  {
    part.X_WP_goal = tool.X_WT_goal * linkage.pose(config.frame, part.link, tool.joints_goal);
  }
}

void Scene::Impl::aimTools()
{
  for (std::size_t k = 0; k < tools_.size(); ++k)
  {
    aim(k, report_.time_s + config_.time_step_s);
  }
}

/** The tool gets where it was to be at the end of the step. */
void Scene::Impl::arrive(Tool& tool)
{
  tool.X_WT = tool.X_WT_goal;
  tool.joints = tool.joints_goal;
  tool.state.X_WT = tool.X_WT;
  tool.state.joints = tool.joints;
  for (std::size_t k = 0; k < tool.parts.size(); ++k)
  {
    tool.parts[k].X_WP = tool.parts[k].X_WP_goal;
    tool.state.parts[k].X_WP = tool.parts[k].X_WP;
  }
}

/** Pose of a tool's part after a share of the step. */
Pose Scene::Impl::partAt(std::size_t index, const ToolPart& part, double s) const
{
  if (s <= 0.0 || s >= 1.0)
  {
    return s <= 0.0 ? part.X_WP : part.X_WP_goal;
  }
  const ToolConfig& config = config_.tools[index];
  const Tool& tool = tools_[index];
  return interpolate(tool.X_WT, tool.X_WT_goal, s) *
         config.linkage.pose(config.frame, part.link,
                             interpolate(tool.joints, tool.joints_goal, s));
}

void Scene::Impl::setJointTargets(std::size_t index, const JointValues& values)
{
  Tool& tool = tools_.at(index);
  if (values.size() != tool.joints.size())
  {
    throw Error("tool " + tool_info_[index].name + " has " + std::to_string(tool.joints.size()) +
                " joints, given are values of " + std::to_string(values.size()));
  }
  tool.joints_target = config_.tools[index].linkage.within(values, tool.joints_target);
}

}  // namespace soft_tissue
