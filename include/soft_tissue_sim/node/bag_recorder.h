#pragma once

#include <rosbag/bag.h>

#include <memory>
#include <string>
#include <vector>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/message_builders.h"

namespace soft_tissue_sim
{
/**
 * Writes what the node would publish, below /sim_node, stamped with simulated time.
 *
 * Wall times are left zero in it: the same run writes the same bytes.
 */
class BagRecorder
{
 public:
  /**
   * @param start          stamp of simulated time zero
   * @param state_rate_hz  most tissue states a simulated second; 0: every step
   * @throws soft_tissue::Error if the file can't be written
   */
  BagRecorder(const std::string& path, const SceneInfo& info, const std::string& world_frame,
              const ros::Time& start, double state_rate_hz);
  /** Closes it as well as it can be. */
  ~BagRecorder();

  /** @throws soft_tissue::Error if it can't be written; then nothing more can be */
  void write(const soft_tissue::Snapshot& snapshot);
  /** @throws soft_tissue::Error if it can't be written to its end */
  void close();

 private:
  soft_tissue::Error failure(const rosbag::BagException& error);
  void writeMeshes();
  void writeTool(std::size_t tool, const soft_tissue::Snapshot& snapshot, const Stamp& stamp);

  const SceneInfo& info_;
  std::string path_;
  std::string world_frame_;
  ros::Time start_;
  double state_period_s_;
  double next_state_s_ = 0.0;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace soft_tissue_sim
