#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <soft_tissue_sim/Progress.h>

#include <cstdint>
#include <string>

#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue_sim
{
/** `progress`: how far things have come that take long, and how they ended. From any thread. */
class ProgressTopic
{
 public:
  explicit ProgressTopic(ros::NodeHandle node);

  /** One of those things, told of by one thread at a time. */
  class Task
  {
   public:
    /** Tells how many are done, at most ten times a second. */
    void advance(std::uint64_t done);
    /** Tells what is at hand now, how many being done before it. */
    void enter(std::uint64_t done, const std::string& message);
    /** Tells how it ended: Progress::DONE, CANCELLED or FAILED. */
    void end(std::uint8_t state, const std::string& message = "");

   private:
    friend class ProgressTopic;
    Task(const ros::Publisher& publisher, const std::string& name, std::uint64_t total);
    void publish();

    ros::Publisher publisher_;
    Progress progress_;
    soft_tissue::Timer since_begin_, since_sent_;
  };

  /** Tells that a task begins. @param total  how many parts it has; 0: none */
  Task begin(const std::string& name, std::uint64_t total) const;

 private:
  ros::Publisher publisher_;
};

}  // namespace soft_tissue_sim
