#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/node/command_check.h"

namespace soft_tissue_sim
{
/** What all of a tool's pose commands go through: counted, warned of when refused, watched for
 * silence. */
class CommandGate
{
 public:
  /** Takes commands that are in order; second: when the sender says, s; empty: now. */
  using Sink = std::function<void(const soft_tissue::Pose& X_WT, std::optional<double> sent_s)>;

  /** @param tool  name for messages; @param watchdog_s  silence after which the pose counts as held
   */
  CommandGate(std::string tool, Sink sink, double watchdog_s);

  /** @param stamp  zero: now */
  void accept(const soft_tissue::Pose& X_WT, const ros::Time& stamp);
  /** Counts the rejection and warns of it, at most once a second. */
  void reject(Rejection rejection, const std::string& detail);

  const std::string& tool() const { return tool_; }
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t rejected(Rejection rejection) const;
  std::uint64_t rejectedInAll() const;
  /** Whether commands came and then stopped for longer than the watchdog allows, or the clock went
   * back since. */
  bool stale() const;
  /** Seconds since the last accepted command; < 0 if the clock went back since. */
  double silence() const;

 private:
  std::string tool_;
  Sink sink_;
  double watchdog_s_;
  double last_warning_s_ = -1.0;  ///< steady clock
  std::array<std::atomic<std::uint64_t>, kRejectionCount> rejected_{};
  std::atomic<std::uint64_t> accepted_{0};
  std::atomic<double> last_accepted_s_{0.0};
};

}  // namespace soft_tissue_sim
