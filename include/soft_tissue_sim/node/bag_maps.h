#pragma once

#include <octomap_msgs/Octomap.h>
#include <ros/time.h>

#include <string>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** Maps of an obstacle in a bag, decoded when their time comes. */
class BagMaps
{
 public:
  /**
   * Gives the obstacle the newest map of a span of time, if there is one. What the node would
   * reject is left out, with a warning on standard error.
   * @param after, until  s, since the bag's start; a map of `until` counts, one of `after` doesn't
   */
  void apply(double after, double until, std::size_t obstacle, soft_tissue::Scene& scene) const;

  std::size_t size() const { return maps_.size(); }

 private:
  friend std::vector<BagMaps> readBagMaps(const std::string& path,
                                          const std::vector<soft_tissue::ObstacleConfig>& obstacles,
                                          const std::string& world_frame, const ros::Time& start,
                                          std::vector<std::string>& warnings);

  struct Map
  {
    double time_s = 0.0;
    soft_tissue::Pose X_WF = soft_tissue::Pose::Identity();  ///< of its frame
    octomap_msgs::Octomap::ConstPtr message;
  };
  std::vector<Map> maps_;  ///< ascending
};

/**
 * Reads the maps of obstacles that a topic brings, `.../<topic>` below any namespace, by their
 * stamps; those of before the start, as latched ones are, count from it on. Frames other than the
 * world are resolved through the bag's tf.
 * @param warnings  what was left out is appended
 * @return one for each obstacle
 * @throws soft_tissue::Error if the file is not a readable bag or two topics have the name
 */
std::vector<BagMaps> readBagMaps(const std::string& path,
                                 const std::vector<soft_tissue::ObstacleConfig>& obstacles,
                                 const std::string& world_frame, const ros::Time& start,
                                 std::vector<std::string>& warnings);

}  // namespace soft_tissue_sim
