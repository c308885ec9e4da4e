#include "bag_transforms.h"

#include <rosbag/view.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>

#include "soft_tissue_sim/node/geometry_conversions.h"

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
  std::sort(stamps_.begin(), stamps_.end());
  stamps_.erase(std::unique(stamps_.begin(), stamps_.end()), stamps_.end());
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
      buffer_.setTransform(transform, "bag", is_static);
      if (!is_static)
      {
        stamps_.push_back(transform.header.stamp);
      }
    }
  }
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
