#include "soft_tissue_sim/node/tf_listener.h"

#include <ros/console.h>

#include <boost/shared_ptr.hpp>
#include <string>

#include "soft_tissue_sim/node/transform_check.h"

namespace soft_tissue_sim
{
namespace
{
constexpr int kQueue = 100;

geometry_msgs::TransformStamped plain(
    const geometry_msgs::TransformStamped_<BoundedAllocator<void>>& bounded)
{
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = bounded.header.stamp;
  transform.header.frame_id.assign(bounded.header.frame_id.begin(), bounded.header.frame_id.end());
  transform.child_frame_id.assign(bounded.child_frame_id.begin(), bounded.child_frame_id.end());
  const auto& t = bounded.transform.translation;
  const auto& r = bounded.transform.rotation;
  transform.transform.translation.x = t.x;
  transform.transform.translation.y = t.y;
  transform.transform.translation.z = t.z;
  transform.transform.rotation.x = r.x;
  transform.transform.rotation.y = r.y;
  transform.transform.rotation.z = r.z;
  transform.transform.rotation.w = r.w;
  return transform;
}
}  // namespace

TfListener::TfListener(tf2::BufferCore& buffer) : buffer_(buffer), spinner_(1, &queue_)
{
  node_.setCallbackQueue(&queue_);
  const auto listen = [this](const std::string& topic, bool is_static) {
    const boost::function<void(const boost::shared_ptr<Message const>&)> take =
        [this, is_static](const boost::shared_ptr<Message const>& message) {
          this->take(*message, is_static);
        };
    return node_.subscribe<Message>(topic, kQueue, take);
  };
  moving_ = listen("/tf", false);
  fixed_ = listen("/tf_static", true);
  spinner_.start();
}

void TfListener::take(const Message& message, bool is_static)
{
  const ros::Time now = ros::Time::now();
  if (now < last_)
  {
    ROS_WARN("the clock went back from %.3f to %.3f s: tf starts anew", last_.toSec(), now.toSec());
    buffer_.clear();
  }
  last_ = now;
  for (const auto& bounded : message.transforms)
  {
    const geometry_msgs::TransformStamped transform = plain(bounded);
    const std::string refusal = transformRefusal(transform);
    if (refusal.empty())
    {
      buffer_.setTransform(transform, "tf", is_static);
    }
    else
    {
      ROS_WARN_THROTTLE(1.0, "transform from '%s' to '%s' refused: %s",
                        transform.child_frame_id.c_str(), transform.header.frame_id.c_str(),
                        refusal.c_str());
    }
  }
}

}  // namespace soft_tissue_sim
