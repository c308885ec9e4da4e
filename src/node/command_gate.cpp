#include "soft_tissue_sim/node/command_gate.h"

#include <ros/console.h>
#include <ros/time.h>

#include <utility>

namespace soft_tissue_sim
{
namespace
{
constexpr double kWarningPeriod = 1.0;  // s

/** Time as the watchdog counts it: simulated if there is a /clock, else steady wall time. */
double watchdogNow()
{
  return ros::Time::isSimTime() ? ros::Time::now().toSec() : ros::SteadyTime::now().toSec();
}

}  // namespace

CommandGate::CommandGate(std::string tool, Sink sink, double watchdog_s)
    : tool_(std::move(tool)), sink_(std::move(sink)), watchdog_s_(watchdog_s)
{}

void CommandGate::accept(const soft_tissue::Pose& X_WT, const ros::Time& stamp)
{
  sink_(X_WT, stamp.isZero() ? std::nullopt : std::make_optional(stamp.toSec()));
  last_accepted_s_ = watchdogNow();
  ++accepted_;
}

void CommandGate::reject(Rejection rejection, const std::string& detail)
{
  ++rejected_[static_cast<std::size_t>(rejection)];
  const double now = ros::SteadyTime::now().toSec();
  if (last_warning_s_ < 0.0 || now - last_warning_s_ > kWarningPeriod)
  {
    last_warning_s_ = now;
    ROS_WARN_STREAM("tool '" << tool_ << "': command rejected: " << rejectionText(rejection)
                             << (detail.empty() ? "" : ": ") << detail << " (" << rejectedInAll()
                             << " rejected so far)");
  }
}

std::uint64_t CommandGate::rejected(Rejection rejection) const
{
  return rejected_[static_cast<std::size_t>(rejection)];
}

std::uint64_t CommandGate::rejectedInAll() const
{
  std::uint64_t sum = 0;
  for (const auto& count : rejected_)
  {
    sum += count;
  }
  return sum;
}

bool CommandGate::stale() const
{
  const double silent_s = silence();
  return accepted_ > 0 && (silent_s > watchdog_s_ || silent_s < 0.0);
}

double CommandGate::silence() const
{
  return watchdogNow() - last_accepted_s_;
}

}  // namespace soft_tissue_sim
