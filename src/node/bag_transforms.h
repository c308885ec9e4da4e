#pragma once

#include <ros/time.h>
#include <rosbag/bag.h>
#include <tf2/buffer_core.h>

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

  /** Stamps of the moving transforms, ascending, each once. */
  const std::vector<ros::Time>& stamps() const { return stamps_; }

  /** Pose of `source` in `target` at a time. @return why there is none, empty if there is one */
  std::string lookup(const std::string& target, const std::string& source, const ros::Time& stamp,
                     soft_tissue::Pose& pose) const;

 private:
  void add(rosbag::Bag& bag, const std::string& topic, bool is_static);

  tf2::BufferCore buffer_;
  std::vector<ros::Time> stamps_;
};

}  // namespace soft_tissue_sim
