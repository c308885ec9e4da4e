#include "soft_tissue_sim/node/bag_playback.h"

#include <cstdio>

#include "bag_topics.h"
#include "soft_tissue_sim/node/scene_loader.h"
#include "soft_tissue_sim/node/scratch_folder.h"

namespace soft_tissue_sim
{
std::vector<PlayedTopic> playedTopics(const std::string& path,
                                      const soft_tissue::SceneConfig& config,
                                      std::vector<std::string>& warnings)
{
  using Kind = soft_tissue::PoseSourceConfig::Kind;
  std::vector<PlayedTopic> played;
  const auto add = [&](const std::string& recorded, const std::string& name) {
    if (!recorded.empty())
    {
      played.push_back({recorded, name});
    }
  };
  readBag(path, [&](rosbag::Bag& bag) {
    const TopicTypes types = topicTypes(bag);
    for (const soft_tissue::ToolConfig& tool : config.tools)
    {
      const ToolTopics topics = toolTopics(types, tool);
      const std::string source = tool.name + "/" + tool.pose_source.name;
      add(topics.twist, source);
      if (tool.pose_source.kind == Kind::topic)
      {
        add(topics.pose, source);
      }
      if (tool.pose_source.kind != Kind::topic && topics.twist.empty() && !topics.pose.empty())
      {
        warnings.push_back(topics.pose + ": the pose_source of tool '" + tool.name +
                           "' takes no poses from topics");
      }
      else if ((tool.pose_source.kind == Kind::topic || tool.pose_source.kind == Kind::twist) &&
               topics.pose.empty() && topics.twist.empty())
      {
        warnings.push_back("it has nothing for " + source);
      }
      add(topics.joints, tool.name + "/" + tool.joint_source.name);
      add(topics.jaw, tool.jaw ? tool.name + "/" + tool.jaw->topic : "");
    }
    for (const soft_tissue::ObstacleConfig& obstacle : config.obstacles)
    {
      const std::string& name = obstacle.octomap.topic;
      add(name.empty() ? "" : findTopic(types, name, "octomap_msgs/Octomap"), name);
    }
    for (const char* const tf : {"/tf", "/tf_static"})
    {
      add(types.count(tf) > 0 ? tf : "", tf);
    }
  });
  return played;
}

void printInputs(const RunOptions& options)
{
  soft_tissue::SceneConfig config = loadConfig(options.scene);
  const ScratchFolder scratch;
  readUrdfs(config, scratch);  // joints are those of their linkages
  std::vector<std::string> warnings;
  for (const PlayedTopic& topic : playedTopics(options.bag_in, config, warnings))
  {
    std::printf("%s:=%s\n", topic.recorded.c_str(), topic.name.c_str());
  }
  for (const std::string& warning : warnings)
  {
    std::fprintf(stderr, "warning: bag %s: %s\n", options.bag_in.c_str(), warning.c_str());
  }
}

}  // namespace soft_tissue_sim
