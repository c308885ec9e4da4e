#include "thread_team.h"

#include <chrono>
#include <utility>

namespace soft_tissue
{
namespace
{
using Clock = std::chrono::steady_clock;

/** How long a helper looks for the next loop before it sleeps. */
constexpr std::chrono::microseconds kPatience(200);
constexpr int kLooksBetweenClockReadings = 64;

std::uint32_t loopOf(std::uint64_t next)
{
  return static_cast<std::uint32_t>(next >> 32);
}

std::uint32_t chunkOf(std::uint64_t next)
{
  return static_cast<std::uint32_t>(next);
}

/** Tells the processor that this thread only waits. */
void rest()
{
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

thread_local bool t_inside = false;  ///< this thread is running chunks
}  // namespace

ThreadTeam::ThreadTeam(int helpers)
{
  for (int k = 0; k < helpers; ++k)
  {
    threads_.emplace_back([this] { help(); });
  }
}

ThreadTeam::~ThreadTeam()
{
  {
    const std::lock_guard<std::mutex> lock(sleep_mutex_);
    ending_ = true;
  }
  woken_.notify_all();
  for (std::thread& thread : threads_)
  {
    thread.join();
  }
}

void ThreadTeam::run(Index chunks, detail::ChunkFunction function, const void* context)
{
  std::unique_lock<std::mutex> caller(callers_, std::defer_lock);
  if (chunks <= 1 || t_inside || !caller.try_lock())
  {
    for (Index chunk = 0; chunk < chunks; ++chunk)
    {
      function(context, chunk);
    }
    return;
  }
  function_.store(function, std::memory_order_relaxed);
  context_.store(context, std::memory_order_relaxed);
  chunks_.store(static_cast<std::uint32_t>(chunks), std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t loop = loopOf(next_.load(std::memory_order_relaxed)) + std::uint64_t{1};
  next_.store(loop << 32, std::memory_order_seq_cst);
  if (sleepers_.load(std::memory_order_seq_cst) > 0)
  {
    {
      const std::lock_guard<std::mutex> lock(sleep_mutex_);
    }
    woken_.notify_all();
  }
  t_inside = true;
  while (runChunk())
  {
  }
  t_inside = false;
  while (done_.load(std::memory_order_acquire) != static_cast<std::uint32_t>(chunks))
  {
    rest();
  }
  if (error_)
  {
    std::rethrow_exception(std::exchange(error_, nullptr));
  }
}

/** Claims one chunk and runs it; false when none is left. */
bool ThreadTeam::runChunk()
{
  std::uint64_t next = next_.load(std::memory_order_acquire);
  for (;;)
  {
    const detail::ChunkFunction function = function_.load(std::memory_order_relaxed);
    const void* context = context_.load(std::memory_order_relaxed);
    if (chunkOf(next) >= chunks_.load(std::memory_order_relaxed))
    {
      return false;
    }
    if (!next_.compare_exchange_weak(next, next + 1, std::memory_order_acq_rel,
                                     std::memory_order_acquire))
    {
      continue;
    }
    try
    {
      function(context, static_cast<Index>(chunkOf(next)));
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(error_mutex_);
      error_ = error_ ? error_ : std::current_exception();
    }
    done_.fetch_add(1, std::memory_order_acq_rel);
    return true;
  }
}

void ThreadTeam::help()
{
  t_inside = true;
  std::uint32_t seen = 0;
  while (waitForLoop(seen))
  {
    seen = loopOf(next_.load(std::memory_order_acquire));
    while (runChunk())
    {
    }
  }
}

/** Waits for another loop than the one seen last; false at the end. */
bool ThreadTeam::waitForLoop(std::uint64_t seen)
{
  const auto another = [&] { return loopOf(next_.load(std::memory_order_seq_cst)) != seen; };
  for (const Clock::time_point end = Clock::now() + kPatience; Clock::now() < end;)
  {
    for (int k = 0; k < kLooksBetweenClockReadings; ++k, rest())
    {
      if (another())
      {
        return true;
      }
    }
  }
  std::unique_lock<std::mutex> lock(sleep_mutex_);
  sleepers_.fetch_add(1, std::memory_order_seq_cst);
  woken_.wait(lock, [&] { return ending_ || another(); });
  sleepers_.fetch_sub(1, std::memory_order_seq_cst);
  return !ending_;
}

}  // namespace soft_tissue
