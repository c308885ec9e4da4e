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
    if (counters_.paused)
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

void PhysicsLoop::setPaused(bool paused)
{
  execute([this, paused] {
    if (counters_.paused && !paused)
    {
      restartClocks();
    }
    counters_.paused = paused;
  });
}

std::optional<double> PhysicsLoop::step(std::uint32_t steps)
{
  std::optional<double> time;
  execute([this, steps, &time] {
    if (!counters_.paused)
    {
      return;
    }
    for (std::uint32_t i = 0; i < steps && !stopping_; ++i)
    {
      advance(true);
    }
    time = scene_.time();
  });
  return time;
}

void PhysicsLoop::resetWorld()
{
  execute([this] {
    forgetCommands();
    scene_.resetWorld();
    ++resets_;
    publishFrame();
  });
}

int PhysicsLoop::attach(const soft_tissue::AttachRequest& request)
{
  int count = 0;
  demand([&] { count = scene_.attach(request); });
  return count;
}

int PhysicsLoop::detach(std::size_t tool, std::optional<std::size_t> part)
{
  int count = 0;
  demand([&] { count = scene_.detach(tool, part); });
  return count;
}

void PhysicsLoop::resetSimulation()
{
  execute([this] {
    forgetCommands();
    scene_.restart();
    restartClocks();
    ++resets_;
    publishFrame();
  });
}

PhysicsLoop::Moment PhysicsLoop::saveState(const std::string& file)
{
  Moment moment;
  demand([&] {
    scene_.saveState(file);
    moment = now();
  });
  return moment;
}

PhysicsLoop::Moment PhysicsLoop::loadState(const std::string& file)
{
  Moment moment;
  demand([&] {
    scene_.loadState(file);
    forgetCommands();
    restartClocks();
    ++resets_;
    publishFrame();
    moment = now();
  });
  return moment;
}

void PhysicsLoop::setMaterial(std::size_t tissue, const soft_tissue::MaterialChange& change)
{
  demand([&] { scene_.setMaterial(tissue, change); });
}

void PhysicsLoop::demand(std::function<void()> task)
{
  if (!execute(std::move(task)))
  {
    throw soft_tissue::Error("the simulation has ended");
  }
}

void PhysicsLoop::forgetCommands()
{
  for (ToolCommands& commands : commands_)
  {
    commands.pose.clear();
    commands.twist.clear();
    commands.joints.clear();
    commands.jaw.clear();
  }
}

PhysicsLoop::Moment PhysicsLoop::now()
{
  scene_.fillSnapshot(asked_);
  return {asked_.report.step, asked_.report.time_s, asked_.state_hash};
}

void PhysicsLoop::setObstacle(std::size_t obstacle, soft_tissue::VoxelSet cells,
                              const soft_tissue::Pose& X_WO)
{
  std::vector<soft_tissue::VoxelSet> spent;  // let go of outside the lock
  auto map = std::make_shared<Map>(Map{std::move(cells), X_WO});
  {
    const std::lock_guard<std::mutex> lock(map_mutex_);
    maps_[obstacle].swap(map);
    spent_.swap(spent);
  }
  if (map == nullptr)
  {
    const std::lock_guard<std::mutex> lock(task_mutex_);
    if (accepting_)
    {
      tasks_.emplace_back([this, obstacle] { takeMap(obstacle); });
    }
    task_added_.notify_all();
  }
}

void PhysicsLoop::takeMap(std::size_t obstacle)
{
  std::shared_ptr<Map> map;
  {
    const std::lock_guard<std::mutex> lock(map_mutex_);
    map.swap(maps_[obstacle]);
  }
  soft_tissue::VoxelSet before = scene_.setObstacle(obstacle, std::move(map->cells), map->X_WO);
  const std::lock_guard<std::mutex> lock(map_mutex_);
  spent_.push_back(std::move(before));
}

/** @return whether it was done: not if the loop has ended */
bool PhysicsLoop::execute(std::function<void()> task)
{
  std::future<void> done;
  {
    const std::lock_guard<std::mutex> lock(task_mutex_);
    if (!accepting_)
    {
      return false;
    }
    tasks_.emplace_back(std::move(task));
    done = tasks_.back().get_future();
  }
  task_added_.notify_all();
  try
  {
    done.get();
    return true;
  }
  catch (const std::future_error&)
  {
    return false;  // it ended before it came to the task
  }
}

void PhysicsLoop::runTasks()
{
  for (;;)
  {
    std::packaged_task<void()> task;
    {
      const std::lock_guard<std::mutex> lock(task_mutex_);
      if (tasks_.empty())
      {
        return;
      }
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task();
  }
}

void PhysicsLoop::waitForTask(double seconds)
{
  std::unique_lock<std::mutex> lock(task_mutex_);
  task_added_.wait_for(lock, std::chrono::duration<double>(seconds),
                       [this] { return stopping_ || !tasks_.empty(); });
}

}  // namespace soft_tissue_sim
