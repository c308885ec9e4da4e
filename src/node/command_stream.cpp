#include "soft_tissue_sim/node/command_stream.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace soft_tissue_sim
{
namespace
{
/** Commands kept: more than a step reads between, at any usual rate. */
constexpr std::size_t kKept = 256;
/** Offsets of the sender's clock that differ by more are those of another clock, s. */
constexpr double kOtherClock = 0.5;
/** Clocks may go apart by this share. */
constexpr double kDrift = 1e-3;
/** Share of the way to a shorter delay taken with each command. */
constexpr double kShorten = 0.002;
/** Share of the way back to the clock taken with each step, and what is a jump, s. */
constexpr double kFollow = 0.1;
constexpr double kJump = 0.2;
/** Before all times. */
constexpr double kAlways = std::numeric_limits<double>::lowest();
}  // namespace

template <typename Sample>
void CommandStream<Sample>::put(const Sample& command, std::optional<double> sent_s,
                                double arrival_s)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!commands_.empty() && arrival_s < last_arrival_s_)
  {
    keepOnlyNewest();
    offset_s_.reset();
  }
  double time_s = localTime(sent_s, arrival_s);
  if (!commands_.empty())
  {
    time_s = std::max(time_s, commands_.times_s.back());
    // Until this one came, steps could go no further than the one before.
    const double needed_s = arrival_s - commands_.times_s.back();
    if (needed_s <= kLongestDelay)
    {
      delay_s_ = needed_s > delay_s_ ? needed_s : delay_s_ + kShorten * (needed_s - delay_s_);
    }
  }
  last_arrival_s_ = arrival_s;
  commands_.times_s.push_back(time_s);
  commands_.samples.push_back(command);
  if (commands_.times_s.size() > kKept)
  {
    commands_.times_s.erase(commands_.times_s.begin(), commands_.times_s.begin() + kKept / 2);
    commands_.samples.erase(commands_.samples.begin(), commands_.samples.begin() + kKept / 2);
  }
}

/** The sender's time on the loop's clock, never later than the arrival. */
template <typename Sample>
double CommandStream<Sample>::localTime(std::optional<double> sent_s, double arrival_s)
{
  if (!sent_s)
  {
    return arrival_s;
  }
  const double offset_s = arrival_s - *sent_s;
  if (!offset_s_ || std::abs(offset_s - *offset_s_) > kOtherClock)
  {
    offset_s_ = offset_s;
    return arrival_s;
  }
  offset_s_ = std::min(*offset_s_ + kDrift * (arrival_s - last_arrival_s_), offset_s);
  return *sent_s + *offset_s_;
}

template <typename Sample>
std::optional<Sample> CommandStream<Sample>::at(double time_s)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (commands_.empty())
  {
    return std::nullopt;
  }
  read_s_ = std::max(read_s_, time_s - delay_s_);  // a longer delay doesn't turn the tool back
  return commands_.at(read_s_);
}

template <typename Sample>
std::optional<Sample> CommandStream<Sample>::newest()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  if (commands_.empty())
  {
    return std::nullopt;
  }
  keepOnlyNewest();
  return commands_.samples.back();
}

template <typename Sample>
void CommandStream<Sample>::keepOnlyNewest()
{
  commands_.times_s = {kAlways};
  commands_.samples = {commands_.samples.back()};
  read_s_ = kAlways;
}

template <typename Sample>
void CommandStream<Sample>::clear()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  commands_ = {};
  offset_s_.reset();
  delay_s_ = 0.0;
  read_s_ = kAlways;
}

template class CommandStream<soft_tissue::Pose>;
template class CommandStream<soft_tissue::JointValues>;

double CommandClock::next(double now_s, double period_s)
{
  const double expected_s = time_s_ ? *time_s_ + period_s : now_s;
  const double behind_s = now_s - expected_s;
  time_s_ = std::abs(behind_s) > kJump ? now_s : expected_s + kFollow * behind_s;
  return *time_s_;
}

}  // namespace soft_tissue_sim
