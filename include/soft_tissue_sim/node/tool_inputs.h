#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>

#include <optional>
#include <string>

#include "soft_tissue_sim/node/stamped_input.h"

namespace soft_tissue_sim
{
/** Takes a tool's poses. */
class PoseInput : public StampedInput<geometry_msgs::PoseStamped>
{
 public:
  PoseInput(PoseGate& gate, const FrameLookup& frames) : StampedInput(gate, frames), gate_(gate) {}

 private:
  Rejection check(const geometry_msgs::PoseStamped& command) const override;
  Rejection take(const geometry_msgs::PoseStamped& command, const soft_tissue::Pose& X_WF) override;

  PoseGate& gate_;
};

/** Takes a tool's velocities, in the axes of the frame they name: the world's, the tool's own or
 * another, whose own motion counts nothing. */
class TwistInput : public StampedInput<geometry_msgs::TwistStamped>
{
 public:
  /** @param tool_frame  the name of the tool's own frame */
  TwistInput(TwistGate& gate, const FrameLookup& frames, std::string tool_frame)
      : StampedInput(gate, frames), gate_(gate), tool_frame_(std::move(tool_frame))
  {}

 private:
  Rejection check(const geometry_msgs::TwistStamped& command) const override;
  bool isKnown(const std::string& frame) const override;
  Rejection take(const geometry_msgs::TwistStamped& command,
                 const soft_tissue::Pose& X_WF) override;

  TwistGate& gate_;
  std::string tool_frame_;
};

/** Lets a tool follow a tf frame. */
class TfInput
{
 public:
  /** @param patience_s  how long the frame may be missing, at the start or later, until that is
   * counted as a rejection, once */
  TfInput(std::string frame, PoseGate& gate, const tf2::BufferCore& buffer, std::string world_frame,
          double patience_s);

  /** Looks the frame up; what is not new is not a command. */
  void poll();

 private:
  void onMissing(const std::string& reason);

  std::string frame_;
  PoseGate& gate_;
  const tf2::BufferCore& buffer_;
  std::string world_frame_;
  double patience_s_;
  ros::Time last_stamp_;
  std::optional<double> missing_since_s_;  ///< steady clock
  bool missing_reported_ = false;
};

}  // namespace soft_tissue_sim
