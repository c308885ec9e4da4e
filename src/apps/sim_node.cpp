#include "soft_tissue_sim/node/sim_node.h"

#include <ros/ros.h>

#include <csignal>

#include "soft_tissue_sim/node/scene_loader.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "sim_node");
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });  // as roscpp does on SIGINT
  const ros::NodeHandle private_node("~");
  try
  {
    using namespace soft_tissue_sim;
    const NodeParams params = readNodeParams(private_node);
    soft_tissue::setThreadCount(params.threads > 0 ? params.threads
                                                   : soft_tissue::usualThreadCount());
    ProgressTopic progress(private_node);
    ProgressTopic::Task loading = progress.begin("load", 2);
    loading.enter(0, "reading " + params.scene);
    const soft_tissue::SceneConfig config = loadConfig(params.scene);
    loading.enter(1, "building tissues, tools and contacts");
    soft_tissue::Scene scene = buildScene(config);
    for (const soft_tissue::TissueInfo& tissue : scene.tissues())
    {
      for (const std::string& remark : tissue.remarks)
      {
        ROS_WARN_STREAM("tissue '" << tissue.name << "': " << remark);
      }
    }
    for (const soft_tissue::ToolConfig& tool : scene.config().tools)
    {
      for (const std::string& remark : tool.remarks)
      {
        ROS_WARN_STREAM("tool '" << tool.name << "': " << remark);
      }
    }
    SimNode node(private_node, params, std::move(scene), progress);
    loading.end(Progress::DONE);
    ROS_INFO_STREAM("simulating " << params.scene);
    ros::spin();
    return node.failed() ? 1 : 0;
  }
  catch (const std::exception& error)
  {
    ROS_FATAL_STREAM(error.what());
    return 1;
  }
}
