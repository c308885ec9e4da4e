#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace soft_tissue_sim
{
/** A command line that can't be understood. */
class UsageError : public std::runtime_error
{
 public:
  using std::runtime_error::runtime_error;
};

/** What run_scene was asked to do. */
struct RunOptions
{
  std::string scene;
  std::optional<double> duration_s;
  std::string bag_in;
  std::string bag_out;
  std::string csv;
  std::string json;
  std::string compare;                ///< CSV file; empty: nothing is compared
  std::optional<double> tare_s;       ///< of the bag's forces, whose mean is taken off
  std::vector<std::string> identify;  ///< SceneParameter names; empty: the scene is run once
  std::string load_state;             ///< file to go on from; empty: from the start
  std::string save_state;             ///< file to end with; empty: none
  std::string world_frame = "world";
  double state_rate_hz = 30.0;  ///< most tissue states a simulated second in the bag; 0: every step
  int threads = 0;              ///< 0: one per processor
  bool quiet = false;
  bool list_inputs = false;  ///< of the bag, in place of running
  bool describe_schema = false;
  bool help = false;
};

/** The text of --help. */
std::string runUsage();

/** @param arguments  without the program's name. @throws UsageError */
RunOptions parseRunOptions(const std::vector<std::string>& arguments);

}  // namespace soft_tissue_sim
