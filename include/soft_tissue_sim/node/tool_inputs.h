#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2_ros/buffer.h>

#include <deque>
#include <optional>
#include <string>

#include "soft_tissue_sim/node/command_gate.h"

namespace soft_tissue_sim
{
/** Takes a tool's poses from a topic; everything runs in the callback queue's thread. */
class TopicInput
{
 public:
  /**
   * @param topic   name below `node`
   * @param wait_s  how long a command may wait for the transform at its stamp
   */
  TopicInput(ros::NodeHandle& node, const std::string& topic, CommandGate& gate,
             const tf2_ros::Buffer& buffer, std::string world_frame, double wait_s);
  TopicInput(const TopicInput&) = delete;
  TopicInput& operator=(const TopicInput&) = delete;

  /** Tries again the commands that wait for their transform. */
  void poll();

 private:
  struct Waiting
  {
    geometry_msgs::PoseStamped::ConstPtr command;
    double since_s;  ///< steady clock
  };
  enum class Resolved
  {
    yes,
    not_yet,
    refused
  };

  void onCommand(const geometry_msgs::PoseStamped::ConstPtr& command);
  Resolved resolve(const geometry_msgs::PoseStamped& command, bool may_wait);

  CommandGate& gate_;
  const tf2_ros::Buffer& buffer_;
  std::string world_frame_;
  double wait_s_;
  StampOrder order_;
  std::deque<Waiting> waiting_;
  ros::Subscriber subscriber_;
};

/** Lets a tool follow a tf frame. */
class TfInput
{
 public:
  /** @param patience_s  how long the frame may be missing, at the start or later, until that is
   * counted as a rejection, once */
  TfInput(std::string frame, CommandGate& gate, const tf2_ros::Buffer& buffer,
          std::string world_frame, double patience_s);

  /** Looks the frame up; what is not new is not a command. */
  void poll();

 private:
  void onMissing(const std::string& reason);

  std::string frame_;
  CommandGate& gate_;
  const tf2_ros::Buffer& buffer_;
  std::string world_frame_;
  double patience_s_;
  ros::Time last_stamp_;
  std::optional<double> missing_since_s_;  ///< steady clock
  bool missing_reported_ = false;
};

}  // namespace soft_tissue_sim
