#include "bag_topics.h"

#include <rosbag/view.h>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
using soft_tissue::Error;

namespace
{
bool endsWithName(const std::string& topic, const std::string& name)
{
  const bool ends = topic.size() >= name.size() &&
                    topic.compare(topic.size() - name.size(), name.size(), name) == 0;
  return ends && (topic.size() == name.size() || topic[topic.size() - name.size() - 1] == '/');
}
}  // namespace

TopicTypes topicTypes(rosbag::Bag& bag)
{
  TopicTypes types;
  rosbag::View view(bag);
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
  {
    types[connection->topic] = connection->datatype;
  }
  return types;
}

std::string findTopic(const TopicTypes& types, const std::string& name, const std::string& type)
{
  std::string found;
  for (const auto& [topic, its_type] : types)
  {
    if (!endsWithName(topic, name))
    {
      continue;
    }
    if (!found.empty())
    {
      throw Error("both " + found + " and " + topic + " may be " + name);
    }
    if (its_type != type)
    {
      throw Error("topic " + topic + " is of type " + its_type + ", must be " + type);
    }
    found = topic;
  }
  return found;
}

ToolTopics toolTopics(const TopicTypes& types, const soft_tissue::ToolConfig& tool)
{
  using PoseKind = soft_tissue::PoseSourceConfig::Kind;
  using JointKind = soft_tissue::JointSourceConfig::Kind;
  const auto find = [&](const std::string& name, const char* type) {
    return findTopic(types, tool.name + "/" + name, type);
  };
  const auto findEither = [&](const std::string& command, const char* measured, const char* type) {
    const std::string topic = find(command, type);
    return topic.empty() ? find(measured, type) : topic;
  };
  const char* const pose_type = "geometry_msgs/PoseStamped";
  const char* const joint_type = "sensor_msgs/JointState";
  ToolTopics topics;
  switch (tool.pose_source.kind)
  {
    case PoseKind::topic:
      topics.pose = findEither(tool.pose_source.name, "measured_cp", pose_type);
      break;
    case PoseKind::twist:
      topics.twist = find(tool.pose_source.name, "geometry_msgs/TwistStamped");
      topics.pose = find("measured_cp", pose_type);
      break;
    case PoseKind::marker:
      topics.pose = find("measured_cp", pose_type);
      break;
    case PoseKind::tf:
    case PoseKind::keyframes:
    case PoseKind::base:
      break;
  }
  if (tool.linkage.coordinates().empty() || tool.joint_source.kind == JointKind::keyframes)
  {
    return topics;
  }
  if (tool.joint_source.kind == JointKind::topic)
  {
    topics.joints = findEither(tool.joint_source.name, "measured_js", joint_type);
  }
  if (tool.jaw)
  {
    topics.jaw = findEither(tool.jaw->topic, "jaw/measured_js", joint_type);
  }
  return topics;
}

void readBag(const std::string& path, const std::function<void(rosbag::Bag&)>& read)
{
  try
  {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    read(bag);
  }
  catch (const rosbag::BagUnindexedException&)
  {
    throw Error("bag " + path + ": is not closed properly or truncated; try 'rosbag reindex'");
  }
  catch (const Error& error)
  {
    throw Error("bag " + path + ": " + error.what());
  }
  catch (const std::exception& error)
  {
    throw Error("bag " + path + ": is not a readable bag: " + error.what());
  }
}

}  // namespace soft_tissue_sim
