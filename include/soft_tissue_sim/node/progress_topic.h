#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <soft_tissue_sim/Progress.h>

#include <cstdint>
#include <mutex>
#include <string>

#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue_sim
{
/** `progress`: how far something has come that takes long, and how it ended; one task at a time.
 * From any thread. */
class ProgressTopic
{
 public:
  explicit ProgressTopic(ros::NodeHandle node);

  /** Tells that a task begins. @param total  how many parts it has; 0: none */
  void begin(const std::string& task, std::uint64_t total);
  /** Tells how many are done, at most ten times a second. */
  void advance(std::uint64_t done);
  /** Tells what is at hand now, how many being done before it. */
  void enter(std::uint64_t done, const std::string& message);
  /** Tells how it ended: Progress::DONE, CANCELLED or FAILED. */
  void end(std::uint8_t state, const std::string& message = "");

 private:
  void publish();

  std::mutex mutex_;
  ros::Publisher publisher_;
  Progress progress_;
  soft_tissue::Timer since_begin_, since_sent_;
};

}  // namespace soft_tissue_sim
