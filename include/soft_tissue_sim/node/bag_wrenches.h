#pragma once

#include <ros/time.h>

#include <optional>
#include <string>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** Forces and moments measured on a tool over time: of tissue on the tool, about the origin of its
 * frame. */
struct WrenchSeries
{
  std::string topic;            ///< empty: the bag has none
  bool in_tool_axes = false;    ///< else in the world's
  std::vector<double> times_s;  ///< ascending
  std::vector<soft_tissue::Wrench> wrenches;

  bool empty() const { return times_s.empty(); }

  /** In the series' axes, linear between samples; none outside, and in gaps of more than 0.1 s. */
  std::optional<soft_tissue::Wrench> at(double time_s) const;

  /** Takes the mean over the first seconds off, for sensors that don't start at zero. @throws
   * soft_tissue::Error if there is no sample in them */
  void tare(double seconds);
};

/**
 * Reads what was measured on each tool: `.../<tool>/body/measured_cf`, in the tool's axes whatever
 * frame its header names, else `.../<tool>/spatial/measured_cf`, in axes of its frame that tf in
 * the bag leads to the world's; sorted by stamp.
 * @param start     where times are counted from; series begin at the first sample not before it
 * @param warnings  what was left out is appended
 * @return one for each tool
 * @throws soft_tissue::Error if the file is not a readable bag or has two such topics for a tool
 */
std::vector<WrenchSeries> readBagWrenches(const std::string& path,
                                          const std::vector<soft_tissue::ToolConfig>& tools,
                                          const std::string& world_frame, const ros::Time& start,
                                          std::vector<std::string>& warnings);

}  // namespace soft_tissue_sim
