#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "soft_tissue_sim/node/bag_poses.h"
#include "soft_tissue_sim/node/scene_info.h"

namespace soft_tissue_sim
{
class WrenchComparison;

/** Sums a run up, step by step. */
class RunSummary
{
 public:
  /** @param bag  what a bag told of the tools; without tools if there is none */
  RunSummary(const soft_tissue::SceneConfig& config, const SceneInfo& info, const BagPoses& bag);

  void add(const soft_tissue::Snapshot& snapshot);

  /**
   * The summary as JSON.
   * @param wall_s      wall time of the whole run, s
   * @param comparison  goes into it; may be null
   */
  std::string json(double wall_s, const WrenchComparison* comparison = nullptr) const;
  /** The summary in a few lines for a terminal. */
  std::string text(double wall_s) const;

  bool finite() const { return finite_; }

 private:
  struct Body
  {
    std::string name;
    std::size_t nodes, tets, triangles, fixed_nodes;
    double max_displacement_m = 0.0;  ///< over the run
  };
  /** On a tool, or on the first tissue of a pair, over the run. */
  struct Force
  {
    void add(double force_n, std::size_t contacts, double time_s);

    double peak_n = 0.0;
    double peak_time_s = 0.0;
    double sum_n = 0.0;
    std::size_t most_contacts = 0;
  };
  struct Tool
  {
    std::string name;
    std::vector<StreamCounts> inputs;  ///< of the bag
    Force force;
  };
  struct Pair
  {
    std::string first, second, name;
    Force force;
    soft_tissue::Vec3 last_force_W = soft_tissue::Vec3::Zero();  ///< N, of the last step
    double max_penetration_m = 0.0;
  };

  void addTool(Tool& sum, const soft_tissue::ToolState& tool, double time_s);
  void addPair(Pair& sum, const soft_tissue::TissuePairState& pair, double time_s);

  std::string scene_;
  double time_step_s_;
  std::vector<soft_tissue::Points> rest_;
  std::vector<Body> bodies_;
  std::vector<Tool> tools_;
  std::vector<Pair> pairs_;
  std::uint64_t steps_ = 0;
  std::uint64_t not_converged_ = 0, held_ = 0, halvings_ = 0;
  std::uint64_t newton_iterations_ = 0, linear_iterations_ = 0;
  double sim_time_s_ = 0.0;
  double min_det_f_ = 1.0;
  double max_penetration_m_ = 0.0;
  double max_residual_ = 0.0;
  bool finite_ = true;
  std::uint64_t state_hash_ = 0;
  soft_tissue::StageTimes ms_sum_;
  std::vector<double> step_ms_;
};

}  // namespace soft_tissue_sim
