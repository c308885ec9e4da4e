#include "soft_tissue_sim/node/bag_poses.h"

#include <algorithm>

#include "bag_stream.h"
#include "bag_transforms.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/joint_inputs.h"
#include "soft_tissue_sim/node/tool_inputs.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Error;
using soft_tissue::JointValues;
using soft_tissue::Pose;
using soft_tissue::ToolConfig;
using Kind = soft_tissue::PoseSourceConfig::Kind;

/** The streams of one tool. */
struct ToolStreams
{
  BagStream<Pose> poses;
  BagStream<Twist> twists;
  BagStream<JointValues> joints, jaw;
};

/** Reads streams in the order of their stamps. */
class Reader
{
 public:
  Reader(rosbag::Bag& bag, std::string world_frame, std::vector<std::string>& warnings)
      : bag_(bag),
        transforms_(bag),
        frames_{transforms_.buffer(), std::move(world_frame), 0.0},
        warnings_(warnings)
  {
    for (const auto& [reason, count] : transforms_.refused())
    {
      warnings.push_back("tf: " + std::to_string(count) + " transforms left out: " + reason);
    }
  }

  ToolStreams read(const ToolConfig& tool, const TopicTypes& types)
  {
    const ToolTopics topics = toolTopics(types, tool);
    ToolStreams streams;
    if (tool.pose_source.kind == Kind::tf)
    {
      streams.poses = posesOfFrame(tool.pose_source.name);
    }
    else if (!topics.pose.empty())
    {
      streams.poses = posesOn(topics.pose);
    }
    if (!topics.twist.empty())
    {
      streams.twists = twistsOn(topics.twist, tool.name);
    }
    if (!topics.joints.empty())
    {
      streams.joints = jointsOn<JointInput>(topics.joints, "joints", tool);
    }
    else if (tool.joint_source.kind == soft_tissue::JointSourceConfig::Kind::tf)
    {
      streams.joints = jointsOfFrames(tool);
    }
    if (!topics.jaw.empty())
    {
      streams.jaw = jointsOn<JawInput>(topics.jaw, "jaw", tool);
    }
    return streams;
  }

 private:
  BagStream<Pose> posesOn(const std::string& topic)
  {
    BagStreamReader<Pose> reader("pose", topic);
    PoseInput input(reader.gate(), frames_);
    reader.readTopic<geometry_msgs::PoseStamped>(
        bag_, [&](const auto& message) { input.onCommand(message); });
    reader.dropDuplicates();
    return reader.take(warnings_);
  }

  BagStream<Twist> twistsOn(const std::string& topic, const std::string& tool_frame)
  {
    BagStreamReader<Twist> reader("twist", topic);
    TwistInput input(reader.gate(), frames_, tool_frame);
    reader.readTopic<geometry_msgs::TwistStamped>(
        bag_, [&](const auto& message) { input.onCommand(message); });
    reader.dropDuplicates();
    return reader.take(warnings_);
  }

  template <typename Input>
  BagStream<JointValues> jointsOn(const std::string& topic, const char* of, const ToolConfig& tool)
  {
    BagStreamReader<JointValues> reader(of, topic);
    Input input(tool, reader.gate());
    // Those of one stamp may name different joints: none is a duplicate.
    reader.template readTopic<sensor_msgs::JointState>(
        bag_, [&](const auto& message) { input.onState(*message); });
    return reader.take(warnings_);
  }

  BagStream<Pose> posesOfFrame(const std::string& frame)
  {
    BagStreamReader<Pose> reader("pose", "/tf");
    reader.readStamps(
        transforms_.stampsBetween(frames_.world_frame, frame), [&](const ros::Time& stamp) {
          Pose X_WT;
          const std::string missing = transforms_.lookup(frames_.world_frame, frame, stamp, X_WT);
          const Rejection rejection =
              missing.empty() ? checkPose(poseMessage(X_WT)) : Rejection::no_transform;
          if (rejection == Rejection::none)
          {
            reader.gate().accept(X_WT, stamp);
          }
          else
          {
            reader.gate().reject(rejection, missing);
          }
        });
    return reader.take(warnings_);
  }

  BagStream<JointValues> jointsOfFrames(const ToolConfig& tool)
  {
    BagStreamReader<JointValues> reader("joints", "/tf");
    JointTfInput input(tool, tool.joint_source.name, reader.gate(), transforms_.buffer(), 0.0);
    std::vector<ros::Time> stamps;
    for (const auto& [parent, child] : input.frames())
    {
      const std::vector<ros::Time> moved = transforms_.stampsBetween(parent, child);
      stamps.insert(stamps.end(), moved.begin(), moved.end());
    }
    std::sort(stamps.begin(), stamps.end());
    stamps.erase(std::unique(stamps.begin(), stamps.end()), stamps.end());
    reader.readStamps(stamps, [&](const ros::Time& stamp) { input.readAt(stamp); });
    return reader.take(warnings_);
  }

  rosbag::Bag& bag_;
  BagTransforms transforms_;
  FrameLookup frames_;
  std::vector<std::string>& warnings_;
};

std::string listTopics(const TopicTypes& types)
{
  std::string list;
  for (const auto& [topic, type] : types)
  {
    list += (list.empty() ? "" : ", ") + topic + " (" + type + ")";
  }
  return list.empty() ? "it has no topics" : "it has " + list;
}

std::string wantedName(const ToolConfig& tool)
{
  const std::string measured = tool.name + "/measured_cp";
  const std::string command = tool.name + "/" + tool.pose_source.name;
  switch (tool.pose_source.kind)
  {
    case Kind::topic:
    case Kind::twist:
      return command + " or " + measured;
    case Kind::marker:
      return measured;
    case Kind::tf:
      return "tf frame " + tool.pose_source.name;
    case Kind::keyframes:
    case Kind::base:
      break;
  }
  return "";
}

std::string wantedNames(const std::vector<ToolConfig>& tools)
{
  std::string names;
  for (const ToolConfig& tool : tools)
  {
    const std::string name = wantedName(tool);
    names += (names.empty() || name.empty() ? "" : ", ") + name;
  }
  return names.empty() ? "nothing: all tools of the scene follow key frames" : names;
}

/** When the streams that move tools begin and end. */
struct Span
{
  template <typename Sample>
  void include(const BagStream<Sample>& stream)
  {
    if (!stream.empty())
    {
      first = std::min(first, stream.stamps.front());
      last = std::max(last, stream.stamps.back());
    }
  }

  void include(const ToolStreams& streams)
  {
    // Measured poses beside velocities only tell where a tool was when those began.
    streams.twists.empty() ? include(streams.poses) : include(streams.twists);
    include(streams.joints);
    include(streams.jaw);
  }

  ros::Time first = ros::TIME_MAX, last = ros::TIME_MIN;
};

BagTool toolOf(const ToolStreams& streams, const ros::Time& start)
{
  BagTool tool;
  tool.poses = streams.poses.since(start);
  tool.twists = streams.twists.since(start);
  tool.joints = streams.joints.since(start);
  tool.jaw = streams.jaw.since(start);
  if (!tool.poses.empty())
  {
    tool.first_pose = tool.twists.empty() ? tool.poses.samples.front() : tool.poses.at(0.0);
  }
  if (!tool.twists.empty())
  {
    tool.poses = {};
  }
  for (const StreamCounts* counts :
       {&streams.poses.counts, &streams.twists.counts, &streams.joints.counts, &streams.jaw.counts})
  {
    if (!counts->of.empty())
    {
      tool.counts.push_back(*counts);
    }
  }
  return tool;
}

BagPoses gather(rosbag::Bag& bag, const std::vector<ToolConfig>& tools,
                const std::string& world_frame)
{
  const TopicTypes types = topicTypes(bag);
  BagPoses poses;
  Reader reader(bag, world_frame, poses.warnings);
  std::vector<ToolStreams> streams;
  std::vector<std::string> without_poses;
  Span span;
  for (const ToolConfig& tool : tools)
  {
    streams.push_back(reader.read(tool, types));
    span.include(streams.back());
    if (streams.back().poses.empty() && streams.back().twists.empty() && !wantedName(tool).empty())
    {
      without_poses.push_back("no poses for tool '" + tool.name + "': it stays where it is");
    }
  }
  if (span.first == ros::TIME_MAX)
  {
    std::string reasons;
    for (const std::string& warning : poses.warnings)
    {
      reasons += "; " + warning;
    }
    throw Error("no usable poses; looked for " + wantedNames(tools) + "; " + listTopics(types) +
                reasons);
  }
  poses.warnings.insert(poses.warnings.end(), without_poses.begin(), without_poses.end());
  poses.start = span.first;
  poses.length_s = (span.last - span.first).toSec();
  for (const ToolStreams& tool : streams)
  {
    poses.tools.push_back(toolOf(tool, poses.start));
  }
  return poses;
}

}  // namespace

BagPoses readBagPoses(const std::string& path, const std::vector<ToolConfig>& tools,
                      const std::string& world_frame)
{
  BagPoses poses;
  readBag(path, [&](rosbag::Bag& bag) { poses = gather(bag, tools, world_frame); });
  return poses;
}

}  // namespace soft_tissue_sim
