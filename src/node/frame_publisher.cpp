#include "soft_tissue_sim/node/frame_publisher.h"

#include <algorithm>
#include <utility>

namespace soft_tissue_sim
{
FramePublisher::FramePublisher(LatestExchange<Frame>& frames) : frames_(frames) {}

FramePublisher::~FramePublisher()
{
  stop();
}

void FramePublisher::addStream(double max_rate_hz, Publish publish)
{
  const std::chrono::duration<double> period(max_rate_hz > 0.0 ? 1.0 / max_rate_hz : 0.0);
  streams_.push_back(
      {std::chrono::duration_cast<Clock::duration>(period), std::move(publish), {}, false});
}

void FramePublisher::addRelay(LatestExchange<Frame>& frames)
{
  addStream(0.0, [&frames](const Frame& frame) {
    frames.back() = frame;
    frames.publish();
  });
}

void FramePublisher::start()
{
  thread_ = std::thread([this] { run(); });
}

void FramePublisher::stop()
{
  stopping_ = true;
  frames_.wake();
  if (thread_.joinable())
  {
    thread_.join();
  }
}

void FramePublisher::republish()
{
  republish_ = true;
  frames_.wake();
}

void FramePublisher::run()
{
  bool any_frame = false;
  Clock::time_point deadline = Clock::now();
  while (!stopping_)
  {
    const bool fresh = frames_.acquire(deadline);
    any_frame = any_frame || fresh;
    const bool mark_all = fresh || republish_.exchange(false);
    const Clock::time_point now = Clock::now();
    deadline = now + std::chrono::hours(1);
    for (Stream& stream : streams_)
    {
      stream.waiting = any_frame && (stream.waiting || mark_all);
      if (stream.waiting && now >= stream.next)
      {
        stream.publish(frames_.front());
        stream.next = now + stream.period;
        stream.waiting = false;
      }
      else if (stream.waiting)
      {
        deadline = std::min(deadline, stream.next);
      }
    }
  }
}

}  // namespace soft_tissue_sim
