#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "soft_tissue_sim/node/physics_loop.h"

namespace soft_tissue_sim
{
/** Runs its streams of messages on one thread of its own, from finished frames only. */
class FramePublisher
{
 public:
  using Publish = std::function<void(const Frame&)>;

  explicit FramePublisher(LatestExchange<Frame>& frames);
  ~FramePublisher();

  /**
   * Adds a stream; only before start(). The last frame is always published, if need be when the
   * rate allows.
   * @param max_rate_hz  most calls a second; 0: every frame this thread sees
   */
  void addStream(double max_rate_hz, Publish publish);
  /** Adds a stream that hands every frame on, to a publisher of what takes longer to make. */
  void addRelay(LatestExchange<Frame>& frames);
  void start();
  void stop();

  /** Publishes the newest frame again on all streams: for subscribers that come late. */
  void republish();

 private:
  using Clock = std::chrono::steady_clock;
  struct Stream
  {
    Clock::duration period;
    Publish publish;
    Clock::time_point next;
    bool waiting = false;
  };

  void run();

  LatestExchange<Frame>& frames_;
  std::vector<Stream> streams_;
  std::atomic<bool> republish_{false};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace soft_tissue_sim
