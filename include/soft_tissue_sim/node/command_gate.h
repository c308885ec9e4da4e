#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "soft_tissue_sim/base/series.h"
#include "soft_tissue_sim/node/command_check.h"
#include "soft_tissue_sim/node/twist_command.h"

namespace soft_tissue_sim
{
/** What becomes of one stream of commands: counted, warned of when refused, watched for silence. */
class CommandWatch
{
 public:
  /** @param what  names the stream in messages, as "probe jaw"; @param watchdog_s  silence after
   * which what it moves counts as held */
  CommandWatch(std::string what, double watchdog_s);

  /** From now on counts alone tell what is refused: for recordings, which are summed up. */
  void beQuiet() { quiet_ = true; }

  /** Counts the rejection and warns of it, at most once a second. */
  void reject(Rejection rejection, const std::string& detail);
  /** The same of a command that was obeyed as far as a joint's limits let it. */
  void noteLimit(const std::string& joint);

  const std::string& what() const { return what_; }
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t rejected(Rejection rejection) const;
  std::uint64_t rejectedInAll() const;
  /** What was said of the first one that was rejected so; kept only where it is quiet. */
  const std::string& firstDetail(Rejection rejection) const;
  std::uint64_t limited() const { return limited_; }
  /** Whether commands came and then stopped for longer than the watchdog allows, or the clock went
   * back since. */
  bool stale() const;
  /** Seconds since the last accepted command; < 0 if the clock went back since. */
  double silence() const;

 protected:
  void countAccepted();

 private:
  void warn(const std::string& text);

  std::string what_;
  double watchdog_s_;
  bool quiet_ = false;
  double last_warning_s_ = -1.0;  ///< steady clock
  std::array<std::atomic<std::uint64_t>, kRejectionCount> rejected_{};
  std::array<std::string, kRejectionCount> first_details_;
  std::atomic<std::uint64_t> accepted_{0}, limited_{0};
  std::atomic<double> last_accepted_s_{0.0};
};

/** What all commands of one stream go through. */
template <typename Command>
class CommandGate : public CommandWatch
{
 public:
  /** Takes commands that are in order; second: when the sender says, s; empty: now. */
  using Sink = std::function<void(const Command& command, std::optional<double> sent_s)>;

  CommandGate(std::string what, Sink sink, double watchdog_s)
      : CommandWatch(std::move(what), watchdog_s), sink_(std::move(sink))
  {}

  /** @param stamp  zero: now */
  void accept(const Command& command, const ros::Time& stamp)
  {
    sink_(command, stamp.isZero() ? std::nullopt : std::make_optional(stamp.toSec()));
    countAccepted();
  }

 private:
  Sink sink_;
};

using PoseGate = CommandGate<soft_tissue::Pose>;
using TwistGate = CommandGate<Twist>;
using JointGate = CommandGate<soft_tissue::JointValues>;

}  // namespace soft_tissue_sim
