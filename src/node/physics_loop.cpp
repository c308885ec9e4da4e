#include "soft_tissue_sim/node/physics_loop.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue_sim
{
namespace
{
constexpr double kMaxWallLag = 0.1;    // s
constexpr double kMaxClockLag = 10.0;  // s: a /clock that moves further at once has jumped
constexpr double kClockPoll = 0.001;   // s
constexpr double kIdleWait = 3600.0;   // s

StepSchedule makeSchedule(double step_s, const PhysicsLoop::Config& config)
{
  if (config.time_source == TimeSource::ros_clock)
  {
    return StepSchedule(step_s, 1.0, kMaxClockLag);
  }
  const bool as_fast_as_possible = config.real_time_factor == 0.0;
  return StepSchedule(step_s, as_fast_as_possible ? 1.0 : config.real_time_factor, kMaxWallLag);
}

}  // namespace

PhysicsLoop::PhysicsLoop(soft_tissue::Scene scene, const Config& config,
                         std::function<void(const std::string&)> on_failure)
    : scene_(std::move(scene)),
      config_(config),
      on_failure_(std::move(on_failure)),
      commands_(scene_.tools().size()),
      schedule_(makeSchedule(scene_.config().time_step_s, config)),
      maps_(scene_.obstacles().size())
{
  counters_.paused = config.paused;
}

PhysicsLoop::~PhysicsLoop()
{
  stop();
}

void PhysicsLoop::start()
{
  thread_ = std::thread([this] {
    try
    {
      run();
    }
    catch (const std::exception& error)
    {
      on_failure_(error.what());
    }
    const std::lock_guard<std::mutex> lock(task_mutex_);
    accepting_ = false;
    tasks_.clear();  // breaks the promises of those who wait
    asked_steps_.clear();
  });
}

void PhysicsLoop::stop()
{
  {
    const std::lock_guard<std::mutex> lock(task_mutex_);
    stopping_ = true;
  }
  task_added_.notify_all();
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void PhysicsLoop::run()
{
  restartClocks();
  publishFrame();
  while (!stopping_)
  {
    runTasks();
    if (!asked_steps_.empty())
    {
      stepAsAsked();
    }
    else if (counters_.paused)
    {
      waitForTask(kIdleWait);
    }
    else if (!stepIfDue())
    {
      waitForTask(secondsToNextStep());
    }
  }
}

bool PhysicsLoop::stepIfDue()
{
  const bool as_fast_as_possible =
      config_.time_source != TimeSource::ros_clock && config_.real_time_factor == 0.0;
  if (as_fast_as_possible)
  {
    advance(true);
    return true;
  }
  if (!clockHasStarted())
  {
    return false;
  }
  const bool due = schedule_.due(clockNow()) > 0;
  counters_.missed_deadlines = schedule_.dropped();
  if (counters_.clock_jumps_back != schedule_.jumpsBack())
  {
    counters_.clock_jumps_back = schedule_.jumpsBack();
    for (ToolCommands& commands : commands_)
    {
      commands.pose.newest();  // which is later than all times now
      commands.joints.newest();
      commands.jaw.newest();
    }
  }
  if (due)
  {
    advance(false);
  }
  return due;
}

/** ROS time is zero until the first /clock: going from there to its first value is no delay. */
bool PhysicsLoop::clockHasStarted()
{
  if (!clock_started_ && clockNow() > 0.0)
  {
    clock_started_ = true;
    restartClocks();
  }
  return clock_started_;
}

void PhysicsLoop::command(std::size_t tool, const soft_tissue::Pose& X_WT,
                          std::optional<double> sent_s)
{
  commands_[tool].pose.put(X_WT, sent_s, clockNow());
}

void PhysicsLoop::commandTwist(std::size_t tool, const Twist& twist)
{
  commands_[tool].twist.put(twist, clockNow());
}

void PhysicsLoop::commandJoints(std::size_t tool, const soft_tissue::JointValues& values,
                                std::optional<double> sent_s)
{
  commands_[tool].joints.put(values, sent_s, clockNow());
}

void PhysicsLoop::commandJaw(std::size_t tool, const soft_tissue::JointValues& values,
                             std::optional<double> sent_s)
{
  commands_[tool].jaw.put(values, sent_s, clockNow());
}

/** Tells the scene where tools go; at_once: to the last commands, as nothing paces the steps. */
void PhysicsLoop::aimTools(bool at_once)
{
  const double time_s = config_.time_source == TimeSource::ros_clock
                            ? schedule_.nextDue()
                            : command_clock_.next(clockNow(), schedule_.period());
  for (std::size_t tool = 0; tool < commands_.size(); ++tool)
  {
    aimTool(tool, at_once ? std::nullopt : std::make_optional(time_s));
  }
}

void PhysicsLoop::aimTool(std::size_t tool, std::optional<double> time_s)
{
  ToolCommands& commands = commands_[tool];
  const auto read = [&](auto& stream) { return time_s ? stream.at(*time_s) : stream.newest(); };
  if (const auto twist = commands.twist.at(clockNow(), config_.watchdog_s))
  {
    scene_.setToolTarget(tool, moved(scene_.toolPose(tool), *twist, scene_.config().time_step_s));
  }
  if (const auto X_WT = read(commands.pose))
  {
    scene_.setToolTarget(tool, *X_WT);
  }
  for (JointStream* stream : {&commands.joints, &commands.jaw})
  {
    if (const auto values = read(*stream))
    {
      scene_.setJointTargets(tool, *values);
    }
  }
}

void PhysicsLoop::advance(bool at_once)
{
  aimTools(at_once);
  const double due_time = schedule_.nextDue();
  scene_.step();
  schedule_.stepDone();
  meter_.stepDone(ros::SteadyTime::now().toSec(), scene_.config().time_step_s);
  ++counters_.steps;
  stamp_ = config_.time_source == TimeSource::ros_clock ? ros::Time(due_time) : ros::Time::now();
  publishFrame();
}

void PhysicsLoop::publishFrame()
{
  Frame& frame = frames_.back();
  scene_.fillSnapshot(frame.snapshot);
  frame.stamp = config_.time_source == TimeSource::own_clock ? ros::Time(scene_.time()) : stamp_;
  frame.real_time_factor = meter_.factor();
  frame.resets = resets_;
  frames_.publish();
}

double PhysicsLoop::clockNow() const
{
  return config_.time_source == TimeSource::ros_clock ? ros::Time::now().toSec()
                                                      : ros::SteadyTime::now().toSec();
}

double PhysicsLoop::secondsToNextStep() const
{
  return config_.time_source == TimeSource::ros_clock ? kClockPoll
                                                      : schedule_.nextDue() - clockNow();
}

void PhysicsLoop::restartClocks()
{
  schedule_.anchor(clockNow());
  meter_.restart(ros::SteadyTime::now().toSec());
  command_clock_.restart();
  stamp_ = ros::Time::now();
}

}  // namespace soft_tissue_sim
