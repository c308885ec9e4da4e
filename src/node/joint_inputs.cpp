#include "soft_tissue_sim/node/joint_inputs.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <utility>

#include "soft_tissue_sim/node/bounded_allocator.h"
#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Coordinate;
using soft_tissue::JointKind;
using soft_tissue::Link;
using soft_tissue::Linkage;
using soft_tissue::Pose;
using soft_tissue::ToolConfig;
using soft_tissue::Vec3;

/** Beyond a limit by more than this is worth a word, rad or m. */
constexpr double kRounding = 1e-6;
/** How far a frame may be from where its joint can have it, m and rad. */
constexpr double kOffByM = 1e-3, kOffByRad = 1e-2;

/** Listens to a topic of states, none of which can take all memory. */
ros::Subscriber subscribeStates(ros::NodeHandle& node, const std::string& topic,
                                const std::function<void(const sensor_msgs::JointState&)>& take)
{
  using Bounded = sensor_msgs::JointState_<BoundedAllocator<void>>;
  const boost::function<void(const boost::shared_ptr<Bounded const>&)> plain =
      [take](const boost::shared_ptr<Bounded const>& bounded) {
        sensor_msgs::JointState state;
        state.header.stamp = bounded->header.stamp;
        for (const auto& name : bounded->name)
        {
          state.name.emplace_back(name.begin(), name.end());
        }
        state.position.assign(bounded->position.begin(), bounded->position.end());
        take(state);
      };
  return node.subscribe<Bounded>(topic, 1, plain, ros::VoidConstPtr(),
                                 ros::TransportHints().tcpNoDelay());
}

std::vector<bool> jointsOfJaw(const ToolConfig& tool)
{
  std::vector<bool> of_jaw(tool.linkage.coordinates().size(), false);
  for (std::size_t k = 0; tool.jaw && k < tool.jaw->joints.size(); ++k)
  {
    of_jaw[tool.linkage.findCoordinate(tool.jaw->joints[k].joint)] = true;
  }
  return of_jaw;
}
}  // namespace

JointCommands::JointCommands(const Linkage& linkage, JointGate& gate)
    : linkage_(linkage),
      gate_(gate),
      values_(soft_tissue::JointValues::Constant(
          static_cast<Eigen::Index>(linkage.coordinates().size()), std::nan("")))
{}

bool JointCommands::accepts(const sensor_msgs::JointState& state)
{
  if (gate_.stale())
  {
    order_.restart();
  }
  const auto finite = [](double value) { return std::isfinite(value); };
  Rejection rejection = Rejection::none;
  if (!std::all_of(state.position.begin(), state.position.end(), finite))
  {
    rejection = Rejection::not_finite;
  }
  else if (!order_.accepts(state.header.stamp))
  {
    rejection = Rejection::stamp_went_back;
  }
  if (rejection != Rejection::none)
  {
    gate_.reject(rejection, "");
    return false;
  }
  return true;
}

void JointCommands::set(std::size_t joint, double value)
{
  const Coordinate& coordinate = linkage_.coordinates()[joint];
  if (value < coordinate.lower - kRounding || value > coordinate.upper + kRounding)
  {
    gate_.noteLimit(coordinate.name);
  }
  values_[static_cast<Eigen::Index>(joint)] = value;
}

void JointCommands::send(const ros::Time& stamp)
{
  order_.accept(stamp, ros::Time::now());
  gate_.accept(values_, stamp);
}

JointInput::JointInput(const ToolConfig& tool, JointGate& gate)
    : commands_(tool.linkage, gate), of_jaw_(jointsOfJaw(tool))
{}

void JointInput::subscribe(ros::NodeHandle& node, const std::string& topic)
{
  subscriber_ = subscribeStates(node, topic,
                                [this](const sensor_msgs::JointState& state) { onState(state); });
}

void JointInput::onState(const sensor_msgs::JointState& state)
{
  if (state.position.size() != state.name.size())
  {
    commands_.gate().reject(Rejection::no_joint, std::to_string(state.name.size()) + " names and " +
                                                     std::to_string(state.position.size()) +
                                                     " positions");
    return;
  }
  if (!commands_.accepts(state))
  {
    return;
  }
  bool any = false;
  for (std::size_t i = 0; i < state.name.size(); ++i)
  {
    const std::size_t joint = commands_.linkage().findCoordinate(state.name[i]);
    if (joint < of_jaw_.size() && !of_jaw_[joint])
    {
      commands_.set(joint, state.position[i]);
      any = true;
    }
  }
  if (!any)
  {
    commands_.gate().reject(Rejection::no_joint, "it names others");
    return;
  }
  commands_.send(state.header.stamp);
}

JawInput::JawInput(const ToolConfig& tool, JointGate& gate)
    : commands_(tool.linkage, gate), joints_(tool.jaw->joints)
{}

void JawInput::subscribe(ros::NodeHandle& node, const std::string& topic)
{
  subscriber_ = subscribeStates(node, topic,
                                [this](const sensor_msgs::JointState& state) { onState(state); });
}

void JawInput::onState(const sensor_msgs::JointState& state)
{
  if (state.position.size() != 1)
  {
    commands_.gate().reject(Rejection::no_joint, std::to_string(state.position.size()) +
                                                     " positions, must be one: the jaw's");
    return;
  }
  if (!commands_.accepts(state))
  {
    return;
  }
  for (const soft_tissue::JawJoint& one : joints_)
  {
    commands_.set(commands_.linkage().findCoordinate(one.joint), one.share * state.position[0]);
  }
  commands_.send(state.header.stamp);
}

JointTfInput::JointTfInput(const ToolConfig& tool, std::string prefix, JointGate& gate,
                           const tf2::BufferCore& buffer, double patience_s)
    : commands_(tool.linkage, gate),
      prefix_(std::move(prefix)),
      buffer_(buffer),
      patience_s_(patience_s),
      angles_(tool.linkage.coordinates().size(), 0.0)
{
  std::vector<bool> told = jointsOfJaw(tool);
  for (const Link& link : tool.linkage.links())
  {
    if (link.kind != JointKind::fixed && link.factor != 0.0 && !told[link.coordinate])
    {
      told[link.coordinate] = true;
      links_.push_back(link);
    }
  }
}

void JointTfInput::poll()
{
  std::string reason;
  const Rejection rejection = lookUp(ros::Time(), reason);
  if (rejection == Rejection::unknown_frame)
  {
    onMissing(reason);
    return;
  }
  missing_since_s_.reset();
  missing_reported_ = false;
  if (links_.empty() || (newest_ == sent_ && commands_.gate().accepted() > 0))
  {
    return;
  }
  const bool is_new = newest_ != sent_;
  sent_ = newest_;
  if (rejection == Rejection::none)
  {
    commands_.send(newest_);
  }
  else if (is_new)
  {
    commands_.gate().reject(rejection, reason);
  }
}

void JointTfInput::readAt(const ros::Time& stamp)
{
  std::string reason;
  const Rejection rejection = lookUp(stamp, reason);
  if (rejection == Rejection::none)
  {
    commands_.send(stamp);
    return;
  }
  commands_.gate().reject(
      rejection == Rejection::unknown_frame ? Rejection::no_transform : rejection, reason);
}

std::vector<std::pair<std::string, std::string>> JointTfInput::frames() const
{
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const Link& link : links_)
  {
    pairs.emplace_back(prefix_ + commands_.linkage().links()[link.parent].name,
                       prefix_ + link.name);
  }
  return pairs;
}

/** Takes the joints from all frames at a time, zero: the newest of each. */
Rejection JointTfInput::lookUp(const ros::Time& stamp, std::string& reason)
{
  newest_ = ros::Time();
  for (const Link& link : links_)
  {
    const Rejection rejection = lookUp(link, stamp, reason);
    if (rejection != Rejection::none)
    {
      return rejection;
    }
  }
  return Rejection::none;
}

Rejection JointTfInput::lookUp(const Link& link, const ros::Time& stamp, std::string& reason)
{
  geometry_msgs::TransformStamped transform;
  try
  {
    transform = buffer_.lookupTransform(prefix_ + commands_.linkage().links()[link.parent].name,
                                        prefix_ + link.name, stamp);
  }
  catch (const std::exception& error)  // tf lets those of ros::Time through
  {
    reason = error.what();
    return Rejection::unknown_frame;
  }
  newest_ = std::max(newest_, transform.header.stamp);
  double& angle = angles_[link.coordinate];
  const std::optional<double> value = jointValue(link, poseFromMessage(transform.transform), angle);
  if (!value)
  {
    reason = "'" + prefix_ + link.name + "'";
    return Rejection::other_motion;
  }
  angle = *value;
  commands_.set(link.coordinate, (*value - link.offset) / link.factor);
  return Rejection::none;
}

void JointTfInput::onMissing(const std::string& reason)
{
  const double now = ros::SteadyTime::now().toSec();
  missing_since_s_ = missing_since_s_.value_or(now);
  if (!missing_reported_ && now - *missing_since_s_ >= patience_s_)
  {
    missing_reported_ = true;
    commands_.gate().reject(Rejection::unknown_frame, reason);
  }
}

std::optional<double> jointValue(const Link& link, const Pose& X_PL, double near)
{
  const Pose X_JL = link.X_PJ.inverse() * X_PL;
  const Eigen::Quaterniond turn(X_JL.linear());
  const bool turns = link.kind == JointKind::turning;
  double value = 0.0;
  Pose expected = Pose::Identity();
  if (turns)
  {
    const double angle = 2.0 * std::atan2(link.axis_J.dot(turn.vec()), turn.w());
    value = angle + 2.0 * M_PI * std::round((near - angle) / (2.0 * M_PI));
    expected.rotate(Eigen::AngleAxisd(value, link.axis_J));
  }
  else
  {
    value = link.axis_J.dot(X_JL.translation());
    expected.translate(value * link.axis_J);
  }
  const bool there = (X_JL.translation() - expected.translation()).norm() <= kOffByM &&
                     turn.angularDistance(Eigen::Quaterniond(expected.linear())) <= kOffByRad;
  return there ? std::make_optional(value) : std::nullopt;
}

double jawPosition(const ToolConfig& tool, const soft_tissue::JointValues& joints)
{
  const soft_tissue::JawJoint& first = tool.jaw->joints[0];
  const std::size_t joint = tool.linkage.findCoordinate(first.joint);
  return joints[static_cast<Eigen::Index>(joint)] / first.share;
}

}  // namespace soft_tissue_sim
