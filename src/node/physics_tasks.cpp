#include <chrono>
#include <utility>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/physics_loop.h"

// What other threads ask of the loop: each is a task that its own thread takes between two steps.
namespace soft_tissue_sim
{
namespace
{
const char* const kEnded = "the simulation has ended";
}  // namespace

void PhysicsLoop::setPaused(bool paused)
{
  execute([this, paused] {
    endAskedSteps();
    if (counters_.paused && !paused)
    {
      restartClocks();
    }
    counters_.paused = paused;
  });
}

PhysicsLoop::Stepped PhysicsLoop::step(std::uint32_t steps, const StepSeen& seen)
{
  std::future<Stepped> reached;
  demand([&] {
    if (!counters_.paused)
    {
      throw soft_tissue::Error("the simulation is running: call pause_physics first");
    }
    reached = asked_steps_.emplace_back(AskedSteps{steps, seen, {}, {}}).reached.get_future();
  });
  try
  {
    return reached.get();
  }
  catch (const std::future_error&)
  {
    throw soft_tissue::Error(kEnded);
  }
}

void PhysicsLoop::stepAsAsked()
{
  AskedSteps& asked = asked_steps_.front();
  advance(true);
  asked.stepped = {asked.stepped.steps + 1, scene_.time()};
  asked.seen(asked.stepped.steps);
  if (asked.stepped.steps == asked.steps)
  {
    asked.reached.set_value(asked.stepped);
    asked_steps_.pop_front();
  }
}

bool PhysicsLoop::cancelSteps()
{
  bool any = false;
  execute([&] {
    any = !asked_steps_.empty();
    endAskedSteps();
  });
  return any;
}

/** Tells those who wait for steps that there will be no more. */
void PhysicsLoop::endAskedSteps()
{
  for (AskedSteps& asked : asked_steps_)
  {
    asked.stepped.time_s = scene_.time();
    asked.reached.set_value(asked.stepped);
  }
  asked_steps_.clear();
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
    throw soft_tissue::Error(kEnded);
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
