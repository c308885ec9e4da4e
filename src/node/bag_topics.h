#pragma once

#include <rosbag/bag.h>

#include <functional>
#include <map>
#include <string>

#include "soft_tissue_sim/scene/tool_config.h"

namespace soft_tissue_sim
{
/** Names and types of a bag's topics. */
using TopicTypes = std::map<std::string, std::string>;

/** Why a message is left out whose type has the right name and another md5 sum. */
constexpr const char* kOtherDefinition = "its message definition is not this machine's";

TopicTypes topicTypes(rosbag::Bag& bag);

/**
 * The one topic that is `name` below any namespace; empty if there is none.
 * @param type  it must have
 * @throws soft_tissue::Error if there are two, or it has another type
 */
std::string findTopic(const TopicTypes& types, const std::string& name, const std::string& type);

/** Topics of a bag that tell of a tool what its sources in the scene would tell; empty: none does.
 */
struct ToolTopics
{
  std::string pose;    ///< commands or, without any, where it was measured
  std::string twist;   ///< commands
  std::string joints;  ///< as `pose`, where topics tell its joints
  std::string jaw;     ///< as `pose`
};

/** @throws soft_tissue::Error as findTopic() */
ToolTopics toolTopics(const TopicTypes& types, const soft_tissue::ToolConfig& tool);

/**
 * Opens a bag and reads it.
 * @throws soft_tissue::Error naming the bag, for one that can't be read and for what `read` throws
 */
void readBag(const std::string& path, const std::function<void(rosbag::Bag&)>& read);

}  // namespace soft_tissue_sim
