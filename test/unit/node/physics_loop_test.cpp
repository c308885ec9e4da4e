#include "soft_tissue_sim/node/physics_loop.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/node/scene_loader.h"

namespace soft_tissue_sim
{
namespace
{
constexpr double kStep = 0.005;  // s, as in the scene
constexpr double kStart = 1000.0;
constexpr std::uint32_t kForLong = 4294967295u;  // steps: more than there is time for

/** Waits until something holds, at most a minute. */
template <typename Condition>
bool waitFor(const Condition& condition)
{
  for (int i = 0; i < 60000 && !condition(); ++i)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return condition();
}

class Loop : public testing::Test
{
 protected:
  Loop() { ros::Time::init(); }
  ~Loop() override { ros::Time::useSystemTime(); }

  void start(TimeSource source, bool paused = false)
  {
    loop_ = std::make_unique<PhysicsLoop>(buildScene(loadConfig(SOURCE_DIR "/test/ros/block.yaml")),
                                          PhysicsLoop::Config{1.0, paused, source},
                                          [](const std::string& what) { ADD_FAILURE() << what; });
    loop_->start();
    EXPECT_TRUE(loop_->frames().acquire(late()));
  }

  PhysicsLoop::Stepped step(std::uint32_t count)
  {
    return loop_->step(count, [this](std::uint32_t done) { seen_.push_back(done); });
  }

  /** Starts under a clock that shows kStart, and waits until the loop follows it. */
  void startUnderClock()
  {
    setClock(kStart);
    start(TimeSource::ros_clock);
    tickUntilFirstStep();
    EXPECT_TRUE(waitFor([this] { return newest().stamp.toSec() > now_ - 0.5 * kStep; }));
    before_ = steps();
  }

  /** Lets the clock go so slowly that a loop that is kept waiting won't give steps up. */
  void tickUntilFirstStep()
  {
    int calls = 0;
    EXPECT_TRUE(waitFor([&] {
      if (calls++ % 20 == 0)
      {
        setClock(now_ + kStep);
      }
      return steps() > 0;
    }));
  }

  void setClock(double seconds)
  {
    now_ = seconds;
    ros::Time::setNow(ros::Time(seconds));
  }

  std::uint64_t steps() const { return loop_->counters().steps; }

  /** So many steps were done since startUnderClock(), and for some time no more. */
  void expectStepped(std::uint64_t count)
  {
    EXPECT_TRUE(waitFor([&] { return steps() >= before_ + count; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_EQ(steps(), before_ + count);
  }

  const Frame& newest()
  {
    loop_->frames().acquire(std::chrono::steady_clock::now());
    return loop_->frames().front();
  }

  /** Asks for more steps than there is time for. */
  std::future<PhysicsLoop::Stepped> stepForLong()
  {
    return std::async(std::launch::async, [this] { return step(kForLong); });
  }

  static LatestExchange<Frame>::Deadline late()
  {
    return std::chrono::steady_clock::now() + std::chrono::seconds(60);
  }

  std::unique_ptr<PhysicsLoop> loop_;
  std::vector<std::uint32_t> seen_;  ///< of step(), by the physics thread
  double now_ = 0.0;
  std::uint64_t before_ = 0;
};

TEST_F(Loop, doesAllStepsTheClockMovesOnBy)
{
  startUnderClock();
  for (int i = 0; i < 20; ++i)
  {
    setClock(now_ + 2 * kStep);
  }
  setClock(now_ + 100 * kStep);
  expectStepped(140);
  EXPECT_NEAR(newest().stamp.toSec(), now_, 1e-6);
  EXPECT_EQ(loop_->counters().missed_deadlines, 0u);
}

TEST_F(Loop, aClockThatStartsIsNoDelay)
{
  setClock(0.0);
  start(TimeSource::ros_clock);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(steps(), 0u);
  setClock(kStart);
  tickUntilFirstStep();
  EXPECT_EQ(loop_->counters().missed_deadlines, 0u);
}

TEST_F(Loop, aClockThatJumpsIsFollowedFromThere)
{
  startUnderClock();
  setClock(now_ - 500.0);
  EXPECT_TRUE(waitFor([this] { return loop_->counters().clock_jumps_back == 1; }));
  setClock(now_ + 10 * kStep);
  expectStepped(10);
  setClock(now_ + 100.0);
  expectStepped(11);
  EXPECT_EQ(loop_->counters().missed_deadlines, 19999u);
  setClock(now_ + 5 * kStep);
  expectStepped(16);
}

TEST_F(Loop, onlyAPausedLoopStepsOnDemand)
{
  start(TimeSource::wall);
  EXPECT_THROW(step(1), soft_tissue::Error);
  EXPECT_TRUE(waitFor([this] { return steps() > 0; }));
  loop_->setPaused(true);
  const std::uint64_t before = steps();
  const double time = step(7).time_s;
  EXPECT_NEAR(time, static_cast<double>(before + 7) * kStep, 1e-9);
  EXPECT_EQ(steps(), before + 7);
  EXPECT_NEAR(newest().snapshot.report.time_s, time, 1e-9);
  loop_->setPaused(false);
  EXPECT_TRUE(waitFor([&] { return steps() > before + 7; }));
}

TEST_F(Loop, obeysTheNewestCommandUntilAReset)
{
  start(TimeSource::own_clock, true);
  const soft_tissue::Pose first = newest().snapshot.tools[0].X_WT;
  for (const double z : {0.07, 0.05})
  {
    loop_->command(0, soft_tissue::Pose(Eigen::Translation3d(0.0, 0.0, z)), std::nullopt);
  }
  step(1);
  EXPECT_NEAR(newest().snapshot.tools[0].X_WT.translation().z(), 0.05, 1e-12);
  loop_->command(0, soft_tissue::Pose(Eigen::Translation3d(0.0, 0.0, 0.08)), std::nullopt);
  loop_->resetWorld();
  EXPECT_TRUE(newest().snapshot.tools[0].X_WT.isApprox(first, 1e-12));
  EXPECT_EQ(newest().resets, 1u);
  EXPECT_NEAR(step(1).time_s, 2 * kStep, 1e-12);
  EXPECT_TRUE(newest().snapshot.tools[0].X_WT.isApprox(first, 1e-12));
  EXPECT_NEAR(newest().stamp.toSec(), 2 * kStep, 1e-9);
}

TEST_F(Loop, endsStepsThatAreCalledOff)
{
  start(TimeSource::wall, true);
  EXPECT_FALSE(loop_->cancelSteps()) << "there are none";
  auto caller = stepForLong();
  EXPECT_TRUE(waitFor([this] { return steps() > 1; }));
  EXPECT_TRUE(loop_->cancelSteps());
  const PhysicsLoop::Stepped stepped = caller.get();
  EXPECT_EQ(stepped.steps, steps());
  EXPECT_NEAR(stepped.time_s, static_cast<double>(steps()) * kStep, 1e-9);
  ASSERT_EQ(seen_.size(), stepped.steps);
  for (std::size_t i = 0; i < seen_.size(); ++i)
  {
    EXPECT_EQ(seen_[i], i + 1);
  }
  EXPECT_FALSE(loop_->cancelSteps());
  EXPECT_EQ(step(2).steps, 2u);
  EXPECT_EQ(steps(), stepped.steps + 2) << "and no others";
}

TEST_F(Loop, stopsInTheMiddleOfALongTask)
{
  start(TimeSource::wall, true);
  auto caller = stepForLong();
  EXPECT_TRUE(waitFor([this] { return steps() > 0; }));
  std::thread waiting([this] { loop_->resetWorld(); });
  loop_->stop();
  waiting.join();
  EXPECT_THROW(caller.get(), soft_tissue::Error);
  EXPECT_THROW(step(1), soft_tissue::Error);
}

TEST_F(Loop, endsALongStepWhenItIsToldToPauseOrToRun)
{
  start(TimeSource::wall, true);
  for (const bool paused : {true, false})
  {
    const std::uint64_t before = steps();
    auto caller = stepForLong();
    EXPECT_TRUE(waitFor([&] { return steps() > before; }));
    loop_->resetWorld();  // other tasks don't wait for the last step, nor end it
    const std::uint64_t between = steps();
    EXPECT_TRUE(waitFor([&] { return steps() > between + 1; }));
    loop_->setPaused(paused);
    const PhysicsLoop::Stepped stepped = caller.get();
    EXPECT_GT(stepped.steps, between - before);
    EXPECT_LT(stepped.steps, kForLong);
    EXPECT_EQ(loop_->counters().paused, paused);
  }
}

TEST_F(Loop, takesStepsOfSeveralOneAfterTheOther)
{
  start(TimeSource::wall, true);
  const auto twenty = [this] { return loop_->step(20, [](std::uint32_t) {}).time_s; };
  auto first = std::async(std::launch::async, twenty);
  auto second = std::async(std::launch::async, twenty);
  EXPECT_NEAR(first.get() + second.get(), (20 + 40) * kStep, 1e-9);
  EXPECT_EQ(steps(), 40u);
}

}  // namespace
}  // namespace soft_tissue_sim
