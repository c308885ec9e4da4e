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

ProgressTopic::Task ProgressTopic::begin(const std::string& name, std::uint64_t total) const
{
  Task task(publisher_, name, total);
  task.publish();
  return task;
}

ProgressTopic::Task::Task(const ros::Publisher& publisher, const std::string& name,
                          std::uint64_t total)
    : publisher_(publisher)
{
  progress_.task = name;
  progress_.total = total;
}

void ProgressTopic::Task::advance(std::uint64_t done)
{
  progress_.done = done;
  if (since_sent_.seconds() >= kPeriod)
  {
    publish();
  }
}

void ProgressTopic::Task::enter(std::uint64_t done, const std::string& message)
{
  progress_.done = done;
  progress_.message = message;
  publish();
}

void ProgressTopic::Task::end(std::uint8_t state, const std::string& message)
{
  progress_.state = state;
  progress_.message = message;
  progress_.done = state == Progress::DONE ? progress_.total : progress_.done;
  publish();
}

void ProgressTopic::Task::publish()
{
  progress_.header.stamp = ros::Time::now();
  progress_.elapsed = since_begin_.seconds();
  publisher_.publish(progress_);
  since_sent_.restart();
}

}  // namespace soft_tissue_sim
