#pragma once

#include <string>
#include <vector>

#include "soft_tissue_sim/node/bag_wrenches.h"
#include "soft_tissue_sim/node/json_writer.h"
#include "soft_tissue_sim/node/replay.h"

namespace soft_tissue_sim
{
/** Measured against simulated, at the end of one step, world axes. */
struct WrenchPair
{
  double time_s = 0.0;
  soft_tissue::Wrench measured_W, simulated_W;
};

/** How far a simulation is from what was measured on one tool. */
struct WrenchErrors
{
  std::size_t samples = 0;
  double measured_n = 0.0;  ///< root mean square of the measured force
  double error_n = 0.0;     ///< root mean square of the difference
  double greatest_error_n = 0.0, greatest_error_time_s = 0.0;
  soft_tissue::Vec3 mean_error_n = soft_tissue::Vec3::Zero();  ///< simulated minus measured, world
  double measured_peak_n = 0.0, simulated_peak_n = 0.0;
  double measured_nm = 0.0, error_nm = 0.0;  ///< the same of the moment
  /** Cosine between both force histories: near -1 the sensor tells the force on the tissue. */
  double likeness = 0.0;
};

WrenchErrors errorsOf(const std::vector<WrenchPair>& pairs);

/** Puts what a simulation has on its tools beside what was measured. */
class WrenchComparison
{
 public:
  /** @throws soft_tissue::Error if nothing was measured on any tool */
  WrenchComparison(std::vector<std::string> tools, std::vector<WrenchSeries> measured);

  /** Takes the end of a step. */
  void add(const soft_tissue::Snapshot& snapshot);

  /** Of a tool, ascending in time; empty where nothing was measured. */
  const std::vector<WrenchPair>& pairs(std::size_t tool) const { return pairs_[tool]; }

  /** An array of the errors of each tool that something was measured on. */
  void write(JsonWriter& json) const;
  /** The same in a few lines for a terminal. */
  std::string text() const;
  /** All pairs: tool, time, measured and simulated force and moment, world axes, SI units.
   * @throws soft_tissue::Error if it can't be written */
  void writeCsv(const std::string& path) const;

 private:
  std::vector<std::string> tools_;
  std::vector<WrenchSeries> measured_;
  std::vector<std::vector<WrenchPair>> pairs_;
};

/** What a replay's bag has to compare with, less what `--tare` takes off; what was left out of it
 * goes to standard error. @throws soft_tissue::Error if there is nothing */
WrenchComparison readComparison(const RunOptions& options, const Replay& replay);

}  // namespace soft_tissue_sim
