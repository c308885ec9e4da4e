#include "soft_tissue_sim/node/sim_node.h"

#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
SimNode::SimNode(const ros::NodeHandle& node, const NodeParams& params, soft_tissue::Scene scene,
                 ProgressTopic& progress)
    : node_(node),
      params_(params),
      info_(scene),
      config_(scene.config()),
      loop_(std::move(scene), params.loop, [this](const std::string& what) { onFailure(what); }),
      publisher_(loop_.frames()),
      slow_publisher_(slow_frames_),
      depths_(info_, config_)
{
  try
  {
    inputs_ = std::make_unique<Inputs>(node_, params_, info_, config_.obstacles, loop_);
  }
  catch (const soft_tissue::Error& error)
  {
    throw soft_tissue::Error("scene " + config_.file + ": " + error.what());
  }
  addOutputs();
  addSlowOutputs();
  diagnostics_timer_ = node_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_->update(); });
  slow_publisher_.start();
  publisher_.start();
  loop_.start();
  services_ = std::make_unique<SimServices>(node_, info_, params_.publish_clock, loop_, progress);
  attach_services_ = std::make_unique<AttachServices>(node_, info_, loop_);
}

SimNode::~SimNode()
{
  diagnostics_timer_.stop();
  loop_.stop();
  services_.reset();
  attach_services_.reset();
  publisher_.stop();
  slow_publisher_.stop();
  inputs_.reset();
}

void SimNode::addOutputs()
{
  const std::string& world = params_.world_frame;
  const RateLimits& rates = params_.rates;
  const ros::SubscriberStatusCallback on_subscriber =
      [this](const ros::SingleSubscriberPublisher&) { publisher_.republish(); };
  scene_topics_ = std::make_unique<SceneTopics>(node_, info_, depths_, params_.markers,
                                                params_.publish_clock, world, on_subscriber);
  if (params_.publish_clock)
  {
    publisher_.addStream(0.0, [this](const Frame& frame) { scene_topics_->publishClock(frame); });
  }
  for (std::size_t tool = 0; tool < info_.tools.size(); ++tool)
  {
    ToolTopics& topics = tool_topics_.emplace_back(node_, info_, tool, world, on_subscriber);
    publisher_.addStream(rates.tool_hz, [&topics](const Frame& frame) { topics.publish(frame); });
  }
  publisher_.addStream(rates.tool_hz,
                       [this](const Frame& frame) { scene_topics_->publishContacts(frame); });
  publisher_.addStream(rates.stats_hz,
                       [this](const Frame& frame) { scene_topics_->publishStats(frame); });
  publisher_.addStream(0.0, [this](const Frame& frame) { inputs_->note(frame); });
  publisher_.addRelay(slow_frames_);
  if (config_.outputs.octomap)
  {
    octomap_topics_ = std::make_unique<OctomapTopics>(node_, config_, info_, world, on_subscriber);
  }
  for (std::size_t tissue = 0; tissue < info_.tissues.size(); ++tissue)
  {
    tissue_topics_.emplace_back(node_, info_, tissue, depths_, world, on_subscriber);
  }
  distances_ = std::make_unique<DistanceService>(node_, info_, world);
  diagnostics_ = std::make_unique<Diagnostics>(loop_, *scene_topics_, octomap_topics_.get(),
                                               inputs_->watches(), inputs_->maps());
}

void SimNode::addSlowOutputs()
{
  const RateLimits& rates = params_.rates;
  slow_publisher_.addStream(0.0, [this](const Frame& frame) {
    distances_->note(frame);
    diagnostics_->note(frame);
  });
  for (TissueTopics& topics : tissue_topics_)
  {
    slow_publisher_.addStream(rates.state_hz,
                              [&topics](const Frame& frame) { topics.publishState(frame); });
    slow_publisher_.addStream(rates.field_hz,
                              [&topics](const Frame& frame) { topics.publishField(frame); });
  }
  slow_publisher_.addStream(rates.marker_hz,
                            [this](const Frame& frame) { scene_topics_->publishMarkers(frame); });
  if (octomap_topics_)
  {
    slow_publisher_.addStream(config_.outputs.octomap->rate_hz,
                              [this](const Frame& frame) { octomap_topics_->publish(frame); });
  }
}

void SimNode::onFailure(const std::string& what)
{
  ROS_FATAL_STREAM("the physics ended: " << what);
  failed_ = true;
  ros::requestShutdown();
}

}  // namespace soft_tissue_sim
