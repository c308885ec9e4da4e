#include "soft_tissue_sim/node/frame_publisher.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace soft_tissue_sim
{
namespace
{
/** Waits until something holds, at most half a minute. */
template <typename Condition>
bool waitFor(const Condition& condition)
{
  for (int i = 0; i < 30000 && !condition(); ++i)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return condition();
}

TEST(FramePublisher, lastFrameGoesOutInSpiteOfTheRateLimitAndEarlierOnesNotAll)
{
  LatestExchange<Frame> frames;
  FramePublisher publisher(frames);
  std::atomic<std::uint64_t> newest{0};
  std::atomic<int> calls{0};
  publisher.addStream(10.0, [&](const Frame& frame) {
    newest = frame.resets;
    ++calls;
  });
  publisher.start();
  for (std::uint64_t i = 1; i <= 50; ++i)
  {
    frames.back().resets = i;
    frames.publish();
  }
  EXPECT_TRUE(waitFor([&] { return newest == 50; }));
  EXPECT_LT(calls, 50);
}

TEST(FramePublisher, republishRepeatsTheLastFrameOnly)
{
  LatestExchange<Frame> frames;
  FramePublisher publisher(frames);
  std::atomic<int> calls{0};
  publisher.addStream(0.0, [&](const Frame& frame) {
    EXPECT_EQ(frame.resets, 7u);
    ++calls;
  });
  publisher.start();
  publisher.republish();  // there is nothing yet
  frames.back().resets = 7;
  frames.publish();
  EXPECT_TRUE(waitFor([&] { return calls == 1; }));
  publisher.republish();
  EXPECT_TRUE(waitFor([&] { return calls == 2; }));
}

TEST(FramePublisher, whatTakesLongHoldsUpNoneOfTheOtherThread)
{
  LatestExchange<Frame> frames, slow_frames;
  FramePublisher publisher(frames), slow(slow_frames);
  std::atomic<std::uint64_t> seen{0}, seen_late{0};
  std::atomic<bool> held{true};
  publisher.addStream(0.0, [&](const Frame& frame) { seen = frame.resets; });
  publisher.addRelay(slow_frames);
  slow.addStream(0.0, [&](const Frame& frame) {
    seen_late = frame.resets;
    EXPECT_TRUE(waitFor([&] { return !held; }));
  });
  slow.start();
  publisher.start();
  for (std::uint64_t i = 1; i <= 20; ++i)
  {
    frames.back().resets = i;
    frames.publish();
    EXPECT_TRUE(waitFor([&] { return seen == i; }));
  }
  EXPECT_LT(seen_late, 20u);
  held = false;
  EXPECT_TRUE(waitFor([&] { return seen_late == 20; }));
}

}  // namespace
}  // namespace soft_tissue_sim
