#include "bag_joints.h"

#include <rosbag/view.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <limits>

#include "bag_topics.h"
#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/joint_inputs.h"

namespace soft_tissue_sim
{
namespace
{
using State = sensor_msgs::JointState;

std::vector<State::ConstPtr> statesByStamp(const rosbag::Bag& bag, const std::string& topic)
{
  std::vector<State::ConstPtr> states;
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view)
  {
    const State::Ptr state = instance.instantiate<State>();
    if (!state)
    {
      throw soft_tissue::Error("topic " + topic + ": " + kOtherDefinition);
    }
    if (state->header.stamp.isZero())
    {
      state->header.stamp = instance.getTime();
    }
    states.push_back(state);
  }
  std::stable_sort(states.begin(), states.end(),
                   [](const State::ConstPtr& a, const State::ConstPtr& b) {
                     return a->header.stamp < b->header.stamp;
                   });
  return states;
}
}  // namespace

soft_tissue::JointSeries JointSamples::since(const ros::Time& start) const
{
  soft_tissue::JointSeries series;
  for (std::size_t i = 0; i < stamps.size(); ++i)
  {
    series.times_s.push_back((stamps[i] - start).toSec());
    series.samples.push_back(values[i]);
  }
  return series;
}

JointSamples readJoints(const rosbag::Bag& bag, const std::string& topic,
                        const soft_tissue::ToolConfig& tool, bool of_jaw,
                        std::vector<std::string>& warnings)
{
  ros::Time::init();  // what watches commands asks for the time
  JointSamples samples;
  JointGate gate(
      tool.name + (of_jaw ? " jaw" : " joint"),
      [&](const soft_tissue::JointValues& values, std::optional<double>) {
        samples.values.push_back(values);
      },
      std::numeric_limits<double>::infinity());
  const auto feed = [&](auto&& input) {
    for (const State::ConstPtr& state : statesByStamp(bag, topic))
    {
      input.onState(*state);
      if (samples.values.size() > samples.stamps.size())
      {
        samples.stamps.push_back(state->header.stamp);
      }
    }
  };
  if (of_jaw)
  {
    feed(JawInput(tool, gate));
  }
  else
  {
    feed(JointInput(tool, gate));
  }
  if (gate.rejectedInAll() > 0)
  {
    warnings.push_back(topic + ": " + std::to_string(gate.rejectedInAll()) +
                       " messages left out: no finite positions of the tool's joints");
  }
  return samples;
}

}  // namespace soft_tissue_sim
