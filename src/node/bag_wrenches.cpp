#include "soft_tissue_sim/node/bag_wrenches.h"

#include <geometry_msgs/WrenchStamped.h>
#include <rosbag/view.h>

#include <algorithm>
#include <map>
#include <memory>

#include "bag_topics.h"
#include "bag_transforms.h"
#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
using soft_tissue::Error;
using soft_tissue::Vec3;
using soft_tissue::Wrench;

const std::string kWrenchType = "geometry_msgs/WrenchStamped";
constexpr double kLongestGap = 0.1;  // s
constexpr double kRounding = 1e-7;   // s, of stamps

struct Sample
{
  ros::Time stamp;
  Wrench wrench;
};

Vec3 vectorOf(const geometry_msgs::Vector3& v)
{
  return Vec3(v.x, v.y, v.z);
}

/** Reads the samples of one topic in the order of the bag. */
class SampleReader
{
 public:
  SampleReader(rosbag::Bag& bag, const std::string& world_frame)
      : bag_(bag), world_frame_(world_frame)
  {}

  std::vector<Sample> read(const WrenchSeries& series, std::vector<std::string>& warnings)
  {
    std::vector<Sample> samples;
    std::map<std::string, std::size_t> refused;
    rosbag::View view(bag_, rosbag::TopicQuery(series.topic));
    for (const rosbag::MessageInstance& instance : view)
    {
      const auto message = instance.instantiate<geometry_msgs::WrenchStamped>();
      if (!message)
      {
        ++refused[kOtherDefinition];
        continue;
      }
      const ros::Time stamp =
          message->header.stamp.isZero() ? instance.getTime() : message->header.stamp;
      Wrench wrench{vectorOf(message->wrench.force), vectorOf(message->wrench.torque)};
      const std::string reason =
          !wrench.force.allFinite() || !wrench.torque.allFinite() ? "not finite"
          : series.in_tool_axes                                   ? ""
                                : turnToWorld(message->header.frame_id, stamp, wrench);
      if (reason.empty())
      {
        samples.push_back({stamp, wrench});
      }
      else
      {
        ++refused[reason];
      }
    }
    for (const auto& [reason, count] : refused)
    {
      warnings.push_back(series.topic + ": " + std::to_string(count) +
                         " forces left out: " + reason);
    }
    std::stable_sort(samples.begin(), samples.end(),
                     [](const Sample& a, const Sample& b) { return a.stamp < b.stamp; });
    return samples;
  }

 private:
  /** @return why it can't be done, empty if it is done */
  std::string turnToWorld(const std::string& frame, const ros::Time& stamp, Wrench& wrench)
  {
    if (frame.empty() || frame == world_frame_)
    {
      return "";
    }
    if (!transforms_)
    {
      transforms_ = std::make_unique<BagTransforms>(bag_);
    }
    soft_tissue::Pose X_WF;
    if (!transforms_->lookup(world_frame_, frame, stamp, X_WF).empty())
    {
      return "tf in the bag does not lead from frame '" + frame + "' to '" + world_frame_ +
             "' at the stamp";
    }
    wrench.force = X_WF.linear() * wrench.force;
    wrench.torque = X_WF.linear() * wrench.torque;
    return "";
  }

  rosbag::Bag& bag_;
  std::string world_frame_;
  std::unique_ptr<BagTransforms> transforms_;  ///< read when first needed
};

WrenchSeries findSeries(const TopicTypes& types, const std::string& tool)
{
  WrenchSeries series;
  series.topic = findTopic(types, tool + "/body/measured_cf", kWrenchType);
  series.in_tool_axes = !series.topic.empty();
  if (series.topic.empty())
  {
    series.topic = findTopic(types, tool + "/spatial/measured_cf", kWrenchType);
  }
  return series;
}

}  // namespace

std::optional<Wrench> WrenchSeries::at(double time_s) const
{
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), time_s - kRounding);
  if (after == times_s.end())
  {
    return std::nullopt;
  }
  const std::size_t next = static_cast<std::size_t>(after - times_s.begin());
  if (*after <= time_s + kRounding)
  {
    return wrenches[next];
  }
  if (next == 0 || *after - times_s[next - 1] > kLongestGap)
  {
    return std::nullopt;
  }
  const double s = (time_s - times_s[next - 1]) / (*after - times_s[next - 1]);
  const Wrench &a = wrenches[next - 1], &b = wrenches[next];
  return Wrench{(1.0 - s) * a.force + s * b.force, (1.0 - s) * a.torque + s * b.torque};
}

void WrenchSeries::tare(double seconds)
{
  Wrench sum;
  std::size_t count = 0;
  while (count < times_s.size() && times_s[count] <= seconds)
  {
    sum.force += wrenches[count].force;
    sum.torque += wrenches[count].torque;
    ++count;
  }
  if (count == 0)
  {
    throw Error("topic " + topic + ": has no force in the first " + std::to_string(seconds) +
                " s to take as zero");
  }
  for (Wrench& wrench : wrenches)
  {
    wrench.force -= sum.force / static_cast<double>(count);
    wrench.torque -= sum.torque / static_cast<double>(count);
  }
}

std::vector<WrenchSeries> readBagWrenches(const std::string& path,
                                          const std::vector<soft_tissue::ToolConfig>& tools,
                                          const std::string& world_frame, const ros::Time& start,
                                          std::vector<std::string>& warnings)
{
  std::vector<WrenchSeries> all;
  readBag(path, [&](rosbag::Bag& bag) {
    const TopicTypes types = topicTypes(bag);
    SampleReader reader(bag, world_frame);
    for (const soft_tissue::ToolConfig& tool : tools)
    {
      WrenchSeries series = findSeries(types, tool.name);
      if (!series.topic.empty())
      {
        for (const Sample& sample : reader.read(series, warnings))
        {
          if (sample.stamp >= start)
          {
            series.times_s.push_back((sample.stamp - start).toSec());
            series.wrenches.push_back(sample.wrench);
          }
        }
      }
      all.push_back(series);
    }
  });
  return all;
}

}  // namespace soft_tissue_sim
