#include "soft_tissue_sim/node/sim_node.h"

#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
using Kind = soft_tissue::PoseSourceConfig::Kind;

constexpr double kTfPatience = 2.0;  // s: nodes that start together don't start at once

}  // namespace

SimNode::SimNode(const ros::NodeHandle& node, const NodeParams& params, soft_tissue::Scene scene)
    : node_(node),
      params_(params),
      info_(scene),
      config_(scene.config()),
      loop_(std::move(scene), params.loop, [this](const std::string& what) { onFailure(what); }),
      depths_(info_, config_),
      publisher_(loop_.frames())
{
  addInputs(config_.tools);
  addMaps(config_.obstacles);
  addOutputs();
  diagnostics_timer_ = node_.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { diagnostics_->update(); });
  publisher_.start();
  loop_.start();
  services_ = std::make_unique<SimServices>(node_, info_, params_.publish_clock, loop_);
}

SimNode::~SimNode()
{
  input_timer_.stop();
  diagnostics_timer_.stop();
  map_inputs_.clear();
  loop_.stop();
  services_.reset();
  publisher_.stop();
}

void SimNode::addInputs(const std::vector<soft_tissue::ToolConfig>& tools)
{
  for (std::size_t tool = 0; tool < tools.size(); ++tool)
  {
    const soft_tissue::PoseSourceConfig& source = tools[tool].pose_source;
    if (source.kind == Kind::keyframes)
    {
      continue;
    }
    if (!listener_)
    {
      listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
    }
    CommandGate& gate = gates_.emplace_back(
        tools[tool].name,
        [this, tool](const soft_tissue::Pose& X_WT, std::optional<double> sent_s) {
          loop_.command(tool, X_WT, sent_s);
        },
        params_.watchdog_s);
    if (source.kind == Kind::topic)
    {
      topic_inputs_.emplace_back(node_, tools[tool].name + "/" + source.name, gate, buffer_,
                                 params_.world_frame, params_.command_wait_s);
      continue;
    }
    for (const soft_tissue::ToolConfig& other : tools)
    {
      if (source.name == other.name)
      {
        throw soft_tissue::Error("scene " + config_.file + ": tool '" + tools[tool].name +
                                 "' follows the tf frame '" + source.name +
                                 "', which is a frame this node broadcasts itself");
      }
    }
    tf_inputs_.emplace_back(source.name, gate, buffer_, params_.world_frame, kTfPatience);
  }
  input_timer_ = node_.createWallTimer(ros::WallDuration(1.0 / params_.tf_poll_hz),
                                       [this](const ros::WallTimerEvent&) { pollInputs(); });
}

void SimNode::addMaps(const std::vector<soft_tissue::ObstacleConfig>& obstacles)
{
  for (std::size_t k = 0; k < obstacles.size(); ++k)
  {
    if (obstacles[k].octomap.topic.empty())
    {
      continue;
    }
    if (!listener_)
    {
      listener_ = std::make_unique<tf2_ros::TransformListener>(buffer_);
    }
    map_inputs_.emplace_back(node_, obstacles[k], buffer_, params_.world_frame, kTfPatience,
                             [this, k](soft_tissue::VoxelSet cells, const soft_tissue::Pose& X_WO) {
                               loop_.setObstacle(k, std::move(cells), X_WO);
                             });
  }
}

void SimNode::addOutputs()
{
  const std::string& world = params_.world_frame;
  const RateLimits& rates = params_.rates;
  const ros::SubscriberStatusCallback on_subscriber =
      [this](const ros::SingleSubscriberPublisher&) { publisher_.republish(); };
  scene_topics_ = std::make_unique<SceneTopics>(node_, info_, depths_, params_.markers,
                                                params_.publish_clock, world, on_subscriber);
  distances_ = std::make_unique<DistanceService>(node_, info_, world);
  publisher_.addStream(0.0, [this](const Frame& frame) { distances_->note(frame); });
  if (config_.outputs.octomap)
  {
    octomap_topics_ = std::make_unique<OctomapTopics>(node_, config_, info_, world, on_subscriber);
    publisher_.addStream(config_.outputs.octomap->rate_hz,
                         [this](const Frame& frame) { octomap_topics_->publish(frame); });
  }
  diagnostics_ = std::make_unique<Diagnostics>(loop_, *scene_topics_, octomap_topics_.get(), gates_,
                                               map_inputs_);
  publisher_.addStream(0.0, [this](const Frame& frame) { diagnostics_->note(frame); });
  if (params_.publish_clock)
  {
    publisher_.addStream(0.0, [this](const Frame& frame) { scene_topics_->publishClock(frame); });
  }
  publisher_.addStream(rates.tool_hz,
                       [this](const Frame& frame) { scene_topics_->publishContacts(frame); });
  for (std::size_t tool = 0; tool < info_.tools.size(); ++tool)
  {
    ToolTopics& topics = tool_topics_.emplace_back(node_, info_, tool, world, on_subscriber);
    publisher_.addStream(rates.tool_hz, [&topics](const Frame& frame) { topics.publish(frame); });
  }
  for (std::size_t tissue = 0; tissue < info_.tissues.size(); ++tissue)
  {
    TissueTopics& topics =
        tissue_topics_.emplace_back(node_, info_, tissue, depths_, world, on_subscriber);
    publisher_.addStream(rates.state_hz,
                         [&topics](const Frame& frame) { topics.publishState(frame); });
    publisher_.addStream(rates.field_hz,
                         [&topics](const Frame& frame) { topics.publishField(frame); });
  }
  publisher_.addStream(rates.stats_hz,
                       [this](const Frame& frame) { scene_topics_->publishStats(frame); });
  publisher_.addStream(rates.marker_hz,
                       [this](const Frame& frame) { scene_topics_->publishMarkers(frame); });
}

void SimNode::pollInputs()
{
  for (TopicInput& input : topic_inputs_)
  {
    input.poll();
  }
  for (TfInput& input : tf_inputs_)
  {
    input.poll();
  }
}

void SimNode::onFailure(const std::string& what)
{
  ROS_FATAL_STREAM("the physics ended: " << what);
  failed_ = true;
  ros::requestShutdown();
}

}  // namespace soft_tissue_sim
