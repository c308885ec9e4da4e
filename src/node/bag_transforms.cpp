#include "bag_transforms.h"

#include <rosbag/view.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "soft_tissue_sim/node/geometry_conversions.h"
#include "soft_tissue_sim/node/transform_check.h"

namespace soft_tissue_sim
{
namespace
{
const ros::Duration kWholeBag(1.0e9);
}  // namespace

BagTransforms::BagTransforms(rosbag::Bag& bag) : buffer_(kWholeBag)
{
  add(bag, "/tf_static", true);
  add(bag, "/tf", false);
}

void BagTransforms::add(rosbag::Bag& bag, const std::string& topic, bool is_static)
{
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view)
  {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (!message)
    {
      continue;
    }
    for (const geometry_msgs::TransformStamped& transform : message->transforms)
    {
      const std::string refusal = transformRefusal(transform);
      if (!refusal.empty())
      {
        ++refused_[refusal];
        continue;
      }
      buffer_.setTransform(transform, "bag", is_static);
      parents_[transform.child_frame_id].insert(transform.header.frame_id);
      if (!is_static)
      {
        stamps_[transform.child_frame_id].push_back(transform.header.stamp);
      }
    }
  }
}

/** A frame and all those it hangs on, and they on. */
std::set<std::string> BagTransforms::upwards(const std::string& frame) const
{
  std::set<std::string> frames;
  std::vector<std::string> next{frame};
  while (!next.empty())
  {
    const std::string one = next.back();
    next.pop_back();
    const auto parents = parents_.find(one);
    if (frames.insert(one).second && parents != parents_.end())
    {
      next.insert(next.end(), parents->second.begin(), parents->second.end());
    }
  }
  return frames;
}

std::vector<ros::Time> BagTransforms::stampsBetween(const std::string& a,
                                                    const std::string& b) const
{
  const std::set<std::string> above_a = upwards(a), above_b = upwards(b);
  std::vector<std::string> way;  // what both hang on moves them alike
  std::set_symmetric_difference(above_a.begin(), above_a.end(), above_b.begin(), above_b.end(),
                                std::back_inserter(way));
  std::set<ros::Time> stamps;
  for (const std::string& frame : way)
  {
    const auto moved = stamps_.find(frame);
    if (moved != stamps_.end())
    {
      stamps.insert(moved->second.begin(), moved->second.end());
    }
  }
  return {stamps.begin(), stamps.end()};
}

std::string BagTransforms::lookup(const std::string& target, const std::string& source,
                                  const ros::Time& stamp, soft_tissue::Pose& pose) const
{
  try
  {
    pose = poseFromMessage(buffer_.lookupTransform(target, source, stamp).transform);
    return "";
  }
  catch (const tf2::TransformException& error)
  {
    return error.what();
  }
}

}  // namespace soft_tissue_sim
