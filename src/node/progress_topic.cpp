#include "soft_tissue_sim/node/progress_topic.h"

namespace soft_tissue_sim
{
namespace
{
constexpr double kPeriod = 0.1;  // s
}  // namespace

ProgressTopic::ProgressTopic(ros::NodeHandle node)
    : publisher_(node.advertise<Progress>("progress", 10, true))
{}

void ProgressTopic::begin(const std::string& task, std::uint64_t total)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  progress_ = Progress();
  progress_.task = task;
  progress_.total = total;
  since_begin_.restart();
  publish();
}

void ProgressTopic::advance(std::uint64_t done)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  progress_.done = done;
  if (since_sent_.seconds() >= kPeriod)
  {
    publish();
  }
}

void ProgressTopic::enter(std::uint64_t done, const std::string& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  progress_.done = done;
  progress_.message = message;
  publish();
}

void ProgressTopic::end(std::uint8_t state, const std::string& message)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  progress_.state = state;
  progress_.message = message;
  progress_.done = state == Progress::DONE ? progress_.total : progress_.done;
  publish();
}

void ProgressTopic::publish()
{
  progress_.header.stamp = ros::Time::now();
  progress_.elapsed = since_begin_.seconds();
  publisher_.publish(progress_);
  since_sent_.restart();
}

}  // namespace soft_tissue_sim
