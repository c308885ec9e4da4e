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

CommandWatch::CommandWatch(std::string what, double watchdog_s)
    : what_(std::move(what)), watchdog_s_(watchdog_s)
{}

void CommandWatch::countAccepted()
{
  last_accepted_s_ = watchdogNow();
  ++accepted_;
}

void CommandWatch::reject(Rejection rejection, const std::string& detail)
{
  const auto kind = static_cast<std::size_t>(rejection);
  if (quiet_ && rejected_[kind] == 0)
  {
    first_details_[kind] = detail;
  }
  ++rejected_[kind];
  warn("command rejected: " + std::string(rejectionText(rejection)) + (detail.empty() ? "" : ": ") +
       detail + " (" + std::to_string(rejectedInAll()) + " rejected so far)");
}

void CommandWatch::noteLimit(const std::string& joint)
{
  ++limited_;
  warn("joint '" + joint + "' is commanded beyond its limits and stays within them (" +
       std::to_string(limited_) + " such commands so far)");
}

void CommandWatch::warn(const std::string& text)
{
  const double now = ros::SteadyTime::now().toSec();
  if (!quiet_ && (last_warning_s_ < 0.0 || now - last_warning_s_ > kWarningPeriod))
  {
    last_warning_s_ = now;
    ROS_WARN_STREAM("tool '" << what_ << "': " << text);
  }
}

std::uint64_t CommandWatch::rejected(Rejection rejection) const
{
  return rejected_[static_cast<std::size_t>(rejection)];
}

std::uint64_t CommandWatch::rejectedInAll() const
{
  std::uint64_t sum = 0;
  for (const auto& count : rejected_)
  {
    sum += count;
  }
  return sum;
}

const std::string& CommandWatch::firstDetail(Rejection rejection) const
{
  return first_details_[static_cast<std::size_t>(rejection)];
}

bool CommandWatch::stale() const
{
  const double silent_s = silence();
  return accepted_ > 0 && (silent_s > watchdog_s_ || silent_s < 0.0);
}

double CommandWatch::silence() const
{
  return watchdogNow() - last_accepted_s_;
}

}  // namespace soft_tissue_sim
