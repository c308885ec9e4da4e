#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include "soft_tissue_sim/node/bounded_allocator.h"

namespace soft_tissue_sim
{
/**
 * Fills a buffer from /tf and /tf_static, in a thread of its own. As tf2_ros::TransformListener,
 * but a message that claims to be endless does not end the process.
 *
 * When the clock goes back the buffer is emptied of what moves.
 */
class TfListener
{
 public:
  /** @param buffer  must outlive it */
  explicit TfListener(tf2::BufferCore& buffer);

 private:
  using Message = tf2_msgs::TFMessage_<BoundedAllocator<void>>;

  void take(const Message& message, bool is_static);

  tf2::BufferCore& buffer_;
  ros::Time last_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::Subscriber moving_, fixed_;
  ros::AsyncSpinner spinner_;
};

}  // namespace soft_tissue_sim
