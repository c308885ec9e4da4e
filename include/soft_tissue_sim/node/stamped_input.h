#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <tf2/buffer_core.h>
#include <tf2/exceptions.h>

#include <deque>
#include <exception>
#include <string>
#include <utility>

#include "soft_tissue_sim/node/command_gate.h"
#include "soft_tissue_sim/node/geometry_conversions.h"

namespace soft_tissue_sim
{
/** Where frames of commands are looked up. */
struct FrameLookup
{
  const tf2::BufferCore& buffer;
  std::string world_frame;
  double wait_s;  ///< how long a command may wait for the transform at its stamp
};

/**
 * Takes stamped commands in order, and brings them to the world frame by tf at their stamps;
 * everything runs in the callback queue's thread.
 */
template <typename Message>
class StampedInput
{
 public:
  using Ptr = typename Message::ConstPtr;

  StampedInput(CommandWatch& watch, FrameLookup frames) : watch_(watch), frames_(std::move(frames))
  {}
  virtual ~StampedInput() = default;
  StampedInput(const StampedInput&) = delete;
  StampedInput& operator=(const StampedInput&) = delete;

  /** Takes what comes on a topic below the node. */
  void subscribe(ros::NodeHandle& node, const std::string& topic)
  {
    subscriber_ = node.subscribe(topic, 1, &StampedInput::onCommand, this,
                                 ros::TransportHints().tcpNoDelay());
  }

  void onCommand(const Ptr& command)
  {
    if (watch_.stale())
    {
      order_.restart();
    }
    const Rejection rejection = check(*command);
    if (rejection != Rejection::none)
    {
      watch_.reject(rejection, "");
      return;
    }
    if (!order_.accepts(command->header.stamp))
    {
      watch_.reject(Rejection::stamp_went_back, "");
      return;
    }
    const Resolved resolved = resolve(*command, frames_.wait_s > 0.0);
    if (resolved != Resolved::refused)
    {
      order_.accept(command->header.stamp, ros::Time::now());
    }
    if (resolved == Resolved::not_yet)
    {
      if (waiting_.size() == kMaxWaiting)
      {
        watch_.reject(Rejection::no_transform, "too many commands wait for tf");
        waiting_.pop_front();
      }
      waiting_.push_back({command, ros::SteadyTime::now().toSec()});
    }
  }

  /** Tries again the commands that wait for their transform. */
  void poll()
  {
    const double now = ros::SteadyTime::now().toSec();
    while (!waiting_.empty())
    {
      const bool may_wait = now - waiting_.front().since_s < frames_.wait_s;
      if (resolve(*waiting_.front().command, may_wait) == Resolved::not_yet)
      {
        return;
      }
      waiting_.pop_front();
    }
  }

 protected:
  /** What is wrong with a command whatever its frame. */
  virtual Rejection check(const Message& command) const = 0;
  /** Whether a frame needs no transform. */
  virtual bool isKnown(const std::string& frame) const
  {
    return frame.empty() || frame == frames_.world_frame;
  }
  /** Hands a command on. @param X_WF  its frame's pose; identity where that is known
   * @return why not, if not */
  virtual Rejection take(const Message& command, const soft_tissue::Pose& X_WF) = 0;

 private:
  static constexpr std::size_t kMaxWaiting = 200;
  struct Waiting
  {
    Ptr command;
    double since_s;  ///< steady clock
  };
  enum class Resolved
  {
    yes,
    not_yet,
    refused
  };

  Resolved resolve(const Message& command, bool may_wait)
  {
    const std::string& frame = command.header.frame_id;
    soft_tissue::Pose X_WF = soft_tissue::Pose::Identity();
    if (!isKnown(frame))
    {
      try
      {
        X_WF = poseFromMessage(
            frames_.buffer.lookupTransform(frames_.world_frame, frame, command.header.stamp)
                .transform);
      }
      catch (const tf2::ExtrapolationException& error)
      {
        if (may_wait)
        {
          return Resolved::not_yet;
        }
        watch_.reject(Rejection::no_transform, "frame '" + frame + "': " + error.what());
        return Resolved::refused;
      }
      catch (const std::exception& error)  // tf lets those of ros::Time through
      {
        watch_.reject(Rejection::unknown_frame, "frame '" + frame + "': " + error.what());
        return Resolved::refused;
      }
    }
    const Rejection rejection = take(command, X_WF);
    if (rejection != Rejection::none)
    {
      watch_.reject(rejection, "in the world frame");
      return Resolved::refused;
    }
    return Resolved::yes;
  }

  CommandWatch& watch_;
  FrameLookup frames_;
  StampOrder order_;
  std::deque<Waiting> waiting_;
  ros::Subscriber subscriber_;
};

}  // namespace soft_tissue_sim
