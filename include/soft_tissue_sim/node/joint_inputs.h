#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soft_tissue_sim/node/command_gate.h"
#include "soft_tissue_sim/scene/tool_config.h"

namespace soft_tissue_sim
{
/** Commands of joints, in order: joints that none named so far are no numbers. */
class JointCommands
{
 public:
  /** @param linkage  must outlive it */
  JointCommands(const soft_tissue::Linkage& linkage, JointGate& gate);

  /** Whether a message is in order and has a finite position for each name it has; counted if not.
   */
  bool accepts(const sensor_msgs::JointState& state);
  /** What a joint is commanded to; noted if that is beyond its limits. */
  void set(std::size_t joint, double value);
  /** Hands all on. @param stamp  of the command just set */
  void send(const ros::Time& stamp);

  const soft_tissue::Linkage& linkage() const { return linkage_; }
  JointGate& gate() { return gate_; }

 private:
  const soft_tissue::Linkage& linkage_;
  JointGate& gate_;
  soft_tissue::JointValues values_;
  StampOrder order_;
};

/** Takes those joints from sensor_msgs/JointState that a message names and no jaw has. */
class JointInput
{
 public:
  JointInput(const soft_tissue::ToolConfig& tool, JointGate& gate);
  void subscribe(ros::NodeHandle& node, const std::string& topic);
  void onState(const sensor_msgs::JointState& state);

 private:
  JointCommands commands_;
  std::vector<bool> of_jaw_;
  ros::Subscriber subscriber_;
};

/** Takes a jaw's position, the only one in a sensor_msgs/JointState, whatever its name. */
class JawInput
{
 public:
  JawInput(const soft_tissue::ToolConfig& tool, JointGate& gate);
  void subscribe(ros::NodeHandle& node, const std::string& topic);
  void onState(const sensor_msgs::JointState& state);

 private:
  JointCommands commands_;
  std::vector<soft_tissue::JawJoint> joints_;
  ros::Subscriber subscriber_;
};

/** Takes joints from where tf has the frames of the links. */
class JointTfInput
{
 public:
  /** @param prefix      what stands before the names of links in those of their frames
   * @param patience_s  as of TfInput */
  JointTfInput(const soft_tissue::ToolConfig& tool, std::string prefix, JointGate& gate,
               const tf2::BufferCore& buffer, double patience_s);

  /** Looks the newest frames up; what is not new is not a command. */
  void poll();
  /** The command that the frames gave at a time; they must all be known then. */
  void readAt(const ros::Time& stamp);

  /** The links whose joints are told so: pairs of frames, of what each hangs on and its own. */
  std::vector<std::pair<std::string, std::string>> frames() const;

 private:
  Rejection lookUp(const ros::Time& stamp, std::string& reason);
  Rejection lookUp(const soft_tissue::Link& link, const ros::Time& stamp, std::string& reason);
  void onMissing(const std::string& reason);

  JointCommands commands_;
  std::vector<soft_tissue::Link> links_;  ///< one that tells of each joint but the jaw's
  std::string prefix_;
  const tf2::BufferCore& buffer_;
  double patience_s_;
  std::vector<double> angles_;  ///< per joint, last seen, so that turns are counted
  ros::Time newest_, sent_;
  std::optional<double> missing_since_s_;  ///< steady clock
  bool missing_reported_ = false;
};

/**
 * The value of a joint that has a link here in the frame of the one it hangs on; of those an angle
 * may have, the one nearest to `near`.
 * @return nothing if the joint cannot have it there
 */
std::optional<double> jointValue(const soft_tissue::Link& link, const soft_tissue::Pose& X_PL,
                                 double near);

/** Positions of a jaw and its joints: the first joint's value over its share. */
double jawPosition(const soft_tissue::ToolConfig& tool, const soft_tissue::JointValues& joints);

}  // namespace soft_tissue_sim
