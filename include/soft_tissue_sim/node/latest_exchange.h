#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

namespace soft_tissue_sim
{
/**
 * Three buffers between one writer and one reader: each works on its own, the third holds the
 * newest. Neither ever waits for the other longer than a swap of indices takes.
 */
template <typename T>
class LatestExchange
{
 public:
  using Deadline = std::chrono::steady_clock::time_point;

  /** The writer's buffer; it holds something old, so that its memory can be reused. */
  T& back() { return buffers_[back_]; }

  /** Hands the writer's buffer over; what was handed over before and not taken is lost. */
  void publish()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      std::swap(back_, middle_);
      fresh_ = true;
    }
    changed_.notify_one();
  }

  /**
   * Waits for something newer than front(), wake() or the deadline.
   * @return whether front() is new
   */
  bool acquire(Deadline deadline)
  {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_until(lock, deadline, [this] { return fresh_ || woken_; });
    woken_ = false;
    if (!fresh_)
    {
      return false;
    }
    std::swap(front_, middle_);
    fresh_ = false;
    return true;
  }

  /** The reader's buffer. */
  const T& front() const { return buffers_[front_]; }

  /** Ends the reader's waiting without anything new. */
  void wake()
  {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      woken_ = true;
    }
    changed_.notify_one();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  T buffers_[3];
  int back_ = 0;
  int middle_ = 1;
  int front_ = 2;
  bool fresh_ = false;
  bool woken_ = false;
};

}  // namespace soft_tissue_sim
