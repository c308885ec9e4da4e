#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>
#include <tf2/buffer_core.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue_sim
{
/** All transforms of a bag's /tf and /tf_static. */
class BagTransforms
{
 public:
  explicit BagTransforms(rosbag::Bag& bag);

  const tf2::BufferCore& buffer() const { return buffer_; }

  /** Stamps of the transforms that move two frames against each other, ascending, each once. */
  std::vector<ros::Time> stampsBetween(const std::string& a, const std::string& b) const;

  /** Pose of `source` in `target` at a time. @return why there is none, empty if there is one */
  std::string lookup(const std::string& target, const std::string& source, const ros::Time& stamp,
                     soft_tissue::Pose& pose) const;

  /** How many transforms tf could not take, by reason. */
  const std::map<std::string, std::size_t>& refused() const { return refused_; }

 private:
  void add(rosbag::Bag& bag, const std::string& topic, bool is_static);
  std::set<std::string> upwards(const std::string& frame) const;

  tf2::BufferCore buffer_;
  std::map<std::string, std::set<std::string>> parents_;  ///< by frame, all it ever had
  std::map<std::string, std::vector<ros::Time>> stamps_;  ///< when a frame was moved
  std::map<std::string, std::size_t> refused_;
};

}  // namespace soft_tissue_sim
