#include "soft_tissue_sim/node/bag_poses.h"

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>

#include "bag_joints.h"
#include "bag_topics.h"
#include "bag_transforms.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/command_check.h"
#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Error;
using soft_tissue::Pose;
using soft_tissue::ToolConfig;
using Kind = soft_tissue::PoseSourceConfig::Kind;

const std::string kPoseType = "geometry_msgs/PoseStamped";

struct Sample
{
  ros::Time stamp;
  Pose X_WT;
};

/** Reads one tool's samples in the order of the bag. */
class SampleReader
{
 public:
  SampleReader(rosbag::Bag& bag, std::string world_frame)
      : bag_(bag), world_frame_(std::move(world_frame))
  {}

  std::vector<Sample> fromTopic(const std::string& topic, std::vector<std::string>& warnings)
  {
    std::vector<Sample> samples;
    std::map<std::string, std::size_t> refused;
    rosbag::View view(bag_, rosbag::TopicQuery(topic));
    for (const rosbag::MessageInstance& instance : view)
    {
      const auto message = instance.instantiate<geometry_msgs::PoseStamped>();
      if (!message)
      {
        ++refused[kOtherDefinition];
        continue;
      }
      const ros::Time stamp =
          message->header.stamp.isZero() ? instance.getTime() : message->header.stamp;
      try
      {
        samples.push_back({stamp, worldPose(*message, stamp)});
      }
      catch (const Error& reason)
      {
        ++refused[reason.what()];
      }
    }
    for (const auto& [reason, count] : refused)
    {
      warnings.push_back(topic + ": " + std::to_string(count) + " poses left out: " + reason);
    }
    return samples;
  }

  std::vector<Sample> fromFrame(const std::string& frame)
  {
    std::vector<Sample> samples;
    for (const ros::Time& stamp : transforms().stamps())
    {
      Pose X_WT;
      if (transforms().lookup(world_frame_, frame, stamp, X_WT).empty() &&
          checkPose(poseMessage(X_WT)) == Rejection::none)
      {
        samples.push_back({stamp, X_WT});
      }
    }
    return samples;
  }

 private:
  Pose worldPose(const geometry_msgs::PoseStamped& message, const ros::Time& stamp)
  {
    const Rejection rejection = checkPose(message.pose);
    if (rejection != Rejection::none)
    {
      throw Error(rejectionText(rejection));
    }
    const std::string& frame = message.header.frame_id;
    const Pose X_FT = poseFromMessage(message.pose);
    if (frame.empty() || frame == world_frame_)
    {
      return X_FT;
    }
    Pose X_WF;
    if (!transforms().lookup(world_frame_, frame, stamp, X_WF).empty())
    {
      throw Error("tf in the bag does not lead from frame '" + frame + "' to '" + world_frame_ +
                  "' at the stamp");
    }
    const Pose X_WT = X_WF * X_FT;
    if (checkPose(poseMessage(X_WT)) != Rejection::none)
    {
      throw Error(rejectionText(checkPose(poseMessage(X_WT))));
    }
    return X_WT;
  }

  const BagTransforms& transforms()
  {
    if (!transforms_)
    {
      transforms_ = std::make_unique<BagTransforms>(bag_);
    }
    return *transforms_;
  }

  rosbag::Bag& bag_;
  std::string world_frame_;
  std::unique_ptr<BagTransforms> transforms_;  ///< read when first needed
};

std::vector<Sample> readSamples(SampleReader& reader, const ToolConfig& tool,
                                const TopicTypes& types, std::vector<std::string>& warnings)
{
  if (tool.pose_source.kind == Kind::tf)
  {
    return reader.fromFrame(tool.pose_source.name);
  }
  std::string topic;
  if (tool.pose_source.kind == Kind::topic)
  {
    topic = findTopic(types, tool.name + "/" + tool.pose_source.name, kPoseType);
  }
  if (topic.empty())
  {
    topic = findTopic(types, tool.name + "/measured_cp", kPoseType);
  }
  return topic.empty() ? std::vector<Sample>() : reader.fromTopic(topic, warnings);
}

/** What a tool's joints, or its jaw's, are in the bag; nothing where something else moves them. */
JointSamples readJointsOf(const rosbag::Bag& bag, const ToolConfig& tool, bool of_jaw,
                          const TopicTypes& types,
                          std::vector<std::string>& warnings)
{
  using JointKind = soft_tissue::JointSourceConfig::Kind;
  const JointKind kind = tool.joint_source.kind;
  if (tool.linkage.coordinates().empty() ||
      (of_jaw ? !tool.jaw || kind == JointKind::keyframes : kind != JointKind::topic))
  {
    return {};
  }
  const char* const state = "sensor_msgs/JointState";
  const std::string name = of_jaw ? tool.jaw->topic : tool.joint_source.name;
  std::string topic = findTopic(types, tool.name + "/" + name, state);
  if (topic.empty())
  {
    topic = findTopic(types, tool.name + (of_jaw ? "/jaw/measured_js" : "/measured_js"), state);
  }
  return topic.empty() ? JointSamples() : readJoints(bag, topic, tool, of_jaw, warnings);
}

std::string listTopics(const TopicTypes& types)
{
  std::string list;
  for (const auto& [topic, type] : types)
  {
    list += (list.empty() ? "" : ", ") + topic + " (" + type + ")";
  }
  return list.empty() ? "it has no topics" : "it has " + list;
}

std::string wantedNames(const std::vector<ToolConfig>& tools)
{
  std::string names;
  for (const ToolConfig& tool : tools)
  {
    const std::string separator = names.empty() ? "" : ", ";
    switch (tool.pose_source.kind)
    {
      case Kind::topic:
        names += separator + tool.name + "/" + tool.pose_source.name + " or " + tool.name +
                 "/measured_cp";
        break;
      case Kind::twist:
      case Kind::marker:
        names += separator + tool.name + "/measured_cp";
        break;
      case Kind::tf:
        names += separator + "tf frame " + tool.pose_source.name;
        break;
      case Kind::keyframes:
      case Kind::base:
        break;
    }
  }
  return names.empty() ? "nothing: all tools of the scene follow key frames" : names;
}

BagPoses gather(rosbag::Bag& bag, const std::vector<ToolConfig>& tools,
                const std::string& world_frame)
{
  const TopicTypes types = topicTypes(bag);
  SampleReader reader(bag, world_frame);
  BagPoses poses;
  std::vector<std::vector<Sample>> samples(tools.size());
  std::vector<JointSamples> joints, jaws;
  std::vector<std::string> without_poses;
  ros::Time first = ros::TIME_MAX;
  ros::Time last = ros::TIME_MIN;
  const auto include = [&](const ros::Time& begin, const ros::Time& end) {
    first = std::min(first, begin);
    last = std::max(last, end);
  };
  for (std::size_t tool = 0; tool < tools.size(); ++tool)
  {
    joints.push_back(readJointsOf(bag, tools[tool], false, types, poses.warnings));
    jaws.push_back(readJointsOf(bag, tools[tool], true, types, poses.warnings));
    for (const JointSamples* read : {&joints.back(), &jaws.back()})
    {
      if (!read->empty())
      {
        include(read->stamps.front(), read->stamps.back());
      }
    }
    if (tools[tool].pose_source.kind == Kind::keyframes ||
        tools[tool].pose_source.kind == Kind::base)
    {
      continue;
    }
    samples[tool] = readSamples(reader, tools[tool], types, poses.warnings);
    std::stable_sort(samples[tool].begin(), samples[tool].end(),
                     [](const Sample& a, const Sample& b) { return a.stamp < b.stamp; });
    if (samples[tool].empty())
    {
      without_poses.push_back("no poses for tool '" + tools[tool].name + "': it stays where it is");
      continue;
    }
    include(samples[tool].front().stamp, samples[tool].back().stamp);
  }
  if (first == ros::TIME_MAX)
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
  poses.start = first;
  poses.length_s = (last - first).toSec();
  poses.tools.resize(tools.size());
  for (std::size_t tool = 0; tool < tools.size(); ++tool)
  {
    poses.joints.push_back(joints[tool].since(first));
    poses.jaws.push_back(jaws[tool].since(first));
  }
  for (std::size_t tool = 0; tool < tools.size(); ++tool)
  {
    for (const Sample& sample : samples[tool])
    {
      poses.tools[tool].times_s.push_back((sample.stamp - first).toSec());
      poses.tools[tool].samples.push_back(sample.X_WT);
    }
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
