#include "soft_tissue_sim/node/inputs.h"

#include <limits>
#include <tuple>
#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::JointSourceConfig;
using soft_tissue::PoseSourceConfig;
using soft_tissue::ToolConfig;

constexpr double kTfPatience = 2.0;  // s: nodes that start together don't start at once

/** Size of a tool: that of the box around its parts, m. */
double sizeOf(const soft_tissue::ToolInfo& tool)
{
  soft_tissue::Vec3 most = soft_tissue::Vec3::Zero();
  for (const soft_tissue::ToolPartInfo& part : tool.parts)
  {
    for (const soft_tissue::Vec3& p : part.surface.nodes)
    {
      most = most.cwiseMax(p.cwiseAbs());
    }
  }
  return 2.0 * most.maxCoeff();
}
}  // namespace

Inputs::Inputs(const ros::NodeHandle& node, const NodeParams& params, const SceneInfo& info,
               const std::vector<soft_tissue::ObstacleConfig>& obstacles, PhysicsLoop& loop)
    : node_(node),
      info_(info),
      listener_(buffer_),
      frames_{buffer_, params.world_frame, params.command_wait_s},
      watchdog_s_(params.loop.watchdog_s)
{
  for (std::size_t tool = 0; tool < info.tool_configs.size(); ++tool)
  {
    addPose(tool, loop);
    addJoints(tool, loop);
  }
  for (std::size_t k = 0; k < obstacles.size(); ++k)
  {
    if (!obstacles[k].octomap.topic.empty())
    {
      maps_.emplace_back(node_, obstacles[k], buffer_, params.world_frame, kTfPatience,
                         [&loop, k](soft_tissue::VoxelSet cells, const soft_tissue::Pose& X_WO) {
                           loop.setObstacle(k, std::move(cells), X_WO);
                         });
    }
  }
  timer_ = node_.createWallTimer(ros::WallDuration(1.0 / params.tf_poll_hz),
                                 [this](const ros::WallTimerEvent&) { poll(); });
}

Inputs::~Inputs()
{
  timer_.stop();
}

void Inputs::addPose(std::size_t tool, PhysicsLoop& loop)
{
  const ToolConfig& config = info_.tool_configs[tool];
  const PoseSourceConfig& source = config.pose_source;
  const std::string topic = config.name + "/" + source.name;
  const auto makeGate = [&](double watchdog_s) -> PoseGate& {
    return pose_gates_.emplace_back(
        config.name,
        [&loop, tool](const soft_tissue::Pose& X_WT, std::optional<double> sent_s) {
          loop.command(tool, X_WT, sent_s);
        },
        watchdog_s);
  };
  switch (source.kind)
  {
    case PoseSourceConfig::Kind::keyframes:
    case PoseSourceConfig::Kind::base:
      return;
    case PoseSourceConfig::Kind::topic:
      poses_.emplace_back(makeGate(watchdog_s_), frames_).subscribe(node_, topic);
      return;
    case PoseSourceConfig::Kind::twist:
      twist_gates_.emplace_back(
          config.name,
          [&loop, tool](const Twist& twist, std::optional<double>) {
            loop.commandTwist(tool, twist);
          },
          watchdog_s_);
      twists_.emplace_back(twist_gates_.back(), frames_, config.name).subscribe(node_, topic);
      return;
    case PoseSourceConfig::Kind::tf:
      addTf(tool, makeGate(watchdog_s_));
      return;
    case PoseSourceConfig::Kind::marker:
      // A marker that nobody drags is where it should be.
      addMarker(tool, makeGate(std::numeric_limits<double>::infinity()));
      return;
  }
}

void Inputs::addTf(std::size_t tool, PoseGate& gate)
{
  const std::string& frame = info_.tool_configs[tool].pose_source.name;
  for (const ToolConfig& other : info_.tool_configs)
  {
    if (frame == other.name)
    {
      throw soft_tissue::Error("tool '" + info_.tool_configs[tool].name +
                               "' follows the tf frame '" + frame +
                               "', which is a frame this node broadcasts itself");
    }
  }
  frames_followed_.emplace_back(frame, gate, buffer_, frames_.world_frame, kTfPatience);
}

void Inputs::addMarker(std::size_t tool, PoseGate& gate)
{
  if (!marker_server_)
  {
    marker_server_ =
        std::make_unique<interactive_markers::InteractiveMarkerServer>(node_.resolveName("tools"));
  }
  const ToolConfig& config = info_.tool_configs[tool];
  markers_.emplace_back(
      std::piecewise_construct, std::forward_as_tuple(tool),
      std::forward_as_tuple(*marker_server_, config.name, gate, frames_,
                            config.initial_pose.toPose(), sizeOf(info_.tools[tool])));
}

void Inputs::addJoints(std::size_t tool, PhysicsLoop& loop)
{
  const ToolConfig& config = info_.tool_configs[tool];
  const JointSourceConfig& source = config.joint_source;
  const std::size_t of_jaw = config.jaw ? config.jaw->joints.size() : 0;
  const auto send = [&loop, tool](const soft_tissue::JointValues& values,
                                  std::optional<double> sent_s) {
    loop.commandJoints(tool, values, sent_s);
  };
  if (source.kind != JointSourceConfig::Kind::keyframes &&
      config.linkage.coordinates().size() > of_jaw)
  {
    JointGate& gate = joint_gates_.emplace_back(config.name + " joint", send, watchdog_s_);
    if (source.kind == JointSourceConfig::Kind::topic)
    {
      joints_.emplace_back(config, gate).subscribe(node_, config.name + "/" + source.name);
    }
    else
    {
      joint_frames_.emplace_back(config, source.name, gate, buffer_, kTfPatience);
    }
  }
  if (config.jaw && source.kind != JointSourceConfig::Kind::keyframes)
  {
    joint_gates_.emplace_back(
        config.name + " jaw",
        [&loop, tool](const soft_tissue::JointValues& values, std::optional<double> sent_s) {
          loop.commandJaw(tool, values, sent_s);
        },
        watchdog_s_);
    jaws_.emplace_back(config, joint_gates_.back())
        .subscribe(node_, config.name + "/" + config.jaw->topic);
  }
}

std::vector<const CommandWatch*> Inputs::watches() const
{
  std::vector<const CommandWatch*> all;
  const auto add = [&](const auto& gates) {
    for (const CommandWatch& gate : gates)
    {
      all.push_back(&gate);
    }
  };
  add(pose_gates_);
  add(twist_gates_);
  add(joint_gates_);
  return all;
}

void Inputs::note(const Frame& frame)
{
  for (auto& [tool, marker] : markers_)
  {
    marker.follow(frame.snapshot.tools[tool].X_WT, frame.resets);
  }
}

void Inputs::poll()
{
  const auto pollAll = [](auto& inputs) {
    for (auto& input : inputs)
    {
      input.poll();
    }
  };
  pollAll(poses_);
  pollAll(twists_);
  pollAll(frames_followed_);
  pollAll(joint_frames_);
  for (auto& [tool, marker] : markers_)
  {
    marker.poll();
  }
}

}  // namespace soft_tissue_sim
