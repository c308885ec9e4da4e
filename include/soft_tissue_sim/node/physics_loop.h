#pragma once

#include <ros/time.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "soft_tissue_sim/node/command_stream.h"
#include "soft_tissue_sim/node/latest_exchange.h"
#include "soft_tissue_sim/node/real_time_meter.h"
#include "soft_tissue_sim/node/step_schedule.h"
#include "soft_tissue_sim/node/twist_command.h"
#include "soft_tissue_sim/scene/material_change.h"
#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** What moves simulated time on, and what messages are stamped with. */
enum class TimeSource
{
  wall,       ///< the wall clock; stamps are wall time
  own_clock,  ///< the wall clock; stamps are simulated time, for a node that publishes /clock
  ros_clock,  ///< somebody else's /clock; stamps are its time
};

/** A finished step with what a publisher must know besides. */
struct Frame
{
  soft_tissue::Snapshot snapshot;
  ros::Time stamp;
  double real_time_factor = 0.0;
  std::uint64_t resets = 0;
};

/** Counts of the loop that anyone may read at any time. */
struct LoopCounters
{
  std::atomic<std::uint64_t> steps{0};
  std::atomic<std::uint64_t> missed_deadlines{0};
  std::atomic<std::uint64_t> clock_jumps_back{0};
  std::atomic<bool> paused{false};
};

/** What a tool is told, between the callbacks and the physics thread. */
struct ToolCommands
{
  PoseStream pose;
  TwistCommand twist;
  JointStream joints, jaw;  ///< of one tool's joints, NaN for those that others set
};

/** The one thread that owns the scene. */
class PhysicsLoop
{
 public:
  struct Config
  {
    double real_time_factor = 1.0;  ///< simulated over wall time; 0: as fast as possible
    bool paused = false;
    TimeSource time_source = TimeSource::wall;
    double watchdog_s = 0.5;  ///< silence of commands after which tools stay where they are
  };

  /** @param on_failure  called in the physics thread if it has to end for an exception */
  PhysicsLoop(soft_tissue::Scene scene, const Config& config,
              std::function<void(const std::string&)> on_failure);
  ~PhysicsLoop();

  void start();
  /** Ends the thread after the step it is in. */
  void stop();

  /** Tells where a tool shall be; `sent_s` is as in CommandStream::put(). From any thread. */
  void command(std::size_t tool, const soft_tissue::Pose& X_WT, std::optional<double> sent_s);
  void commandTwist(std::size_t tool, const Twist& twist);
  /** Values of those joints that are not the jaw's; NaN: as they are. */
  void commandJoints(std::size_t tool, const soft_tissue::JointValues& values,
                     std::optional<double> sent_s);
  /** The same of the jaw's joints. */
  void commandJaw(std::size_t tool, const soft_tissue::JointValues& values,
                  std::optional<double> sent_s);
  /** Gives an obstacle other cells, and a pose, before the next step; of several the newest counts.
   * From any thread, which then lets go of cells there were. */
  void setObstacle(std::size_t obstacle, soft_tissue::VoxelSet cells,
                   const soft_tissue::Pose& X_WO);

  void setPaused(bool paused);
  /** How far steps that were asked for came. */
  struct Stepped
  {
    std::uint32_t steps = 0;
    double time_s = 0.0;  ///< simulated, at the end of the last one
  };
  /** Called after each step with how many are done, in the physics thread. */
  using StepSeen = std::function<void(std::uint32_t done)>;
  /** Steps a paused loop, and waits for the last one; cancelSteps() and setPaused() end it earlier,
   * other tasks are taken between two steps. @param steps  at least 1
   * @throws soft_tissue::Error if it is not paused, or the loop ends */
  Stepped step(std::uint32_t steps, const StepSeen& seen);
  /** Ends each step() after the step it is in. From any thread. @return whether there is one */
  bool cancelSteps();
  /** Rest shape and initial tool poses; commands given before are forgotten; time goes on. */
  void resetWorld();
  /** The same, and time begins again at zero. */
  void resetSimulation();
  /** Scene::attach(). @throws soft_tissue::Error as that does */
  int attach(const soft_tissue::AttachRequest& request);
  /** Scene::detach(). @throws soft_tissue::Error as that does */
  int detach(std::size_t tool, std::optional<std::size_t> part);
  /** Where the simulation stood when something was done to it. */
  struct Moment
  {
    std::uint64_t step = 0;
    double time_s = 0.0;
    std::uint64_t state_hash = 0;
  };
  /** @throws soft_tissue::Error as Scene::saveState() */
  Moment saveState(const std::string& file);
  /** Commands given before are forgotten. @throws soft_tissue::Error as Scene::loadState() */
  Moment loadState(const std::string& file);
  /** @throws soft_tissue::Error as Scene::setMaterial() */
  void setMaterial(std::size_t tissue, const soft_tissue::MaterialChange& change);

  LatestExchange<Frame>& frames() { return frames_; }
  const LoopCounters& counters() const { return counters_; }

 private:
  void run();
  void runTasks();
  void waitForTask(double seconds);
  bool execute(std::function<void()> task);
  void demand(std::function<void()> task);
  void takeMap(std::size_t obstacle);
  void forgetCommands();
  Moment now();
  bool stepIfDue();
  void stepAsAsked();
  void endAskedSteps();
  bool clockHasStarted();
  void aimTools(bool at_once);
  void aimTool(std::size_t tool, std::optional<double> time_s);
  void advance(bool at_once);
  void publishFrame();
  double clockNow() const;
  double secondsToNextStep() const;
  void restartClocks();

  soft_tissue::Scene scene_;
  Config config_;
  std::function<void(const std::string&)> on_failure_;
  std::deque<ToolCommands> commands_;  ///< one per tool
  CommandClock command_clock_;
  StepSchedule schedule_;
  bool clock_started_ = false;
  RealTimeMeter meter_;
  std::uint64_t resets_ = 0;
  ros::Time stamp_;

  /** Cells on their way to the scene, and those that come back. */
  struct Map
  {
    soft_tissue::VoxelSet cells;
    soft_tissue::Pose X_WO;
  };
  std::mutex map_mutex_;
  std::vector<std::shared_ptr<Map>> maps_;  ///< per obstacle, null: none
  std::vector<soft_tissue::VoxelSet> spent_;
  soft_tissue::Snapshot asked_;  ///< of now()

  /** Of a step(). */
  struct AskedSteps
  {
    std::uint32_t steps;
    StepSeen seen;
    Stepped stepped;
    std::promise<Stepped> reached;
  };
  std::deque<AskedSteps> asked_steps_;  ///< one after the other

  LatestExchange<Frame> frames_;
  LoopCounters counters_;
  std::mutex task_mutex_;
  std::condition_variable task_added_;
  std::deque<std::packaged_task<void()>> tasks_;
  bool accepting_ = true;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace soft_tissue_sim
