#include "thread_team.h"

#include <chrono>
#include <string>
#include <system_error>
#include <utility>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
using Clock = std::chrono::steady_clock;
constexpr std::chrono::microseconds kPatience(200);  ///< before a thread sleeps
constexpr std::chrono::microseconds kHurry(20);      ///< before it lets others run meanwhile
constexpr int kLooks = 64;                           ///< between two looks at the clock
constexpr int kPieceBits = 24;                       ///< of a ticket; the others are the loop's
constexpr std::uint64_t kMostPieces = (1u << kPieceBits) - 1;
constexpr std::uint64_t kLoops = std::uint64_t(1) << (64 - kPieceBits);

thread_local bool in_loop = false;

void pause()
{
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

/** Waits for something that should be there in no time. @return whether it came */
template <typename Condition>
bool spinUntil(const Condition& condition)
{
  Clock::time_point begin;
  for (bool first = true;; first = false)
  {
    for (int i = 0; i < kLooks; ++i)
    {
      if (condition())
      {
        return true;
      }
      pause();
    }
    const Clock::time_point now = Clock::now();
    begin = first ? now : begin;
    const Clock::duration waited = now - begin;
    if (waited > kPatience)
    {
      return condition();
    }
    if (waited > kHurry)
    {
      std::this_thread::yield();
    }
  }
}
}  // namespace

ThreadTeam::ThreadTeam(int threads) : shares_(threads)
{
  try
  {
    for (int member = 1; member < threads; ++member)
    {
      threads_.emplace_back([this, member] { work(member); });
    }
  }
  catch (const std::system_error& error)
  {
    end();
    throw Error(std::to_string(threads) + " threads: " + error.what());
  }
}

ThreadTeam::~ThreadTeam()
{
  end();
}

void ThreadTeam::end()
{
  {
    const std::lock_guard<std::mutex> lock(sleep_mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_)
  {
    thread.join();
  }
}

void ThreadTeam::run(Index pieces, detail::ChunkFunction function, const void* context)
{
  const std::unique_lock<std::mutex> alone =
      in_loop ? std::unique_lock<std::mutex>() : std::unique_lock(in_use_, std::try_to_lock);
  if (!alone || static_cast<std::uint64_t>(pieces) > kMostPieces)
  {
    for (Index piece = 0; piece < pieces; ++piece)
    {
      function(context, piece);
    }
    return;
  }
  open(pieces, function, context);
  const Loop loop = {number_.load(std::memory_order_relaxed), pieces, function, context};
  given_ += pieces - takeAll(0, loop);
  const auto finished = [&] { return done_.load(std::memory_order_acquire) == given_; };
  while (!spinUntil(finished))
  {}
  if (error_)
  {
    std::rethrow_exception(std::exchange(error_, nullptr));
  }
}

void ThreadTeam::open(Index pieces, detail::ChunkFunction function, const void* context)
{
  const std::uint64_t number = number_.load(std::memory_order_relaxed);
  number_.store(number + 1, std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_release);
  pieces_.store(pieces, std::memory_order_relaxed);
  function_.store(function, std::memory_order_relaxed);
  context_.store(context, std::memory_order_relaxed);
  number_.store(number + 2, std::memory_order_seq_cst);
  if (sleepers_.load(std::memory_order_seq_cst) > 0)
  {
    {
      const std::lock_guard<std::mutex> lock(sleep_mutex_);  // whoever looked before waits by now
    }
    wake_.notify_all();
  }
}

/** @return whether it is there as a whole */
bool ThreadTeam::look(Loop& loop) const
{
  loop.number = number_.load(std::memory_order_acquire);
  loop.pieces = pieces_.load(std::memory_order_relaxed);
  loop.function = function_.load(std::memory_order_relaxed);
  loop.context = context_.load(std::memory_order_relaxed);
  std::atomic_thread_fence(std::memory_order_acquire);
  return loop.number % 2 == 0 && number_.load(std::memory_order_relaxed) == loop.number;
}

Index ThreadTeam::shareBegin(std::size_t share, Index pieces) const
{
  return static_cast<Index>(share * static_cast<std::uint64_t>(pieces) / shares_.size());
}

void ThreadTeam::work(std::size_t member)
{
  in_loop = true;
  Loop loop;
  while (waitForLoop(loop.number))
  {
    if (look(loop))
    {
      const Index taken = takeAll(member, loop);
      if (taken > 0)
      {
        done_.fetch_add(taken, std::memory_order_release);
      }
    }
  }
}

/** @return whether there is one after the one that was seen; else it is time to end */
bool ThreadTeam::waitForLoop(std::uint64_t seen)
{
  const auto there = [&] {
    return number_.load(std::memory_order_relaxed) != seen ||
           ending_.load(std::memory_order_relaxed);
  };
  if (!spinUntil(there))
  {
    std::unique_lock<std::mutex> lock(sleep_mutex_);
    ++sleepers_;
    wake_.wait(lock, [&] { return number_.load() != seen || ending_.load(); });
    --sleepers_;
  }
  return !ending_;
}

/** Pieces of a thread's own share first, then of others'. @return how many it did */
Index ThreadTeam::takeAll(std::size_t member, const Loop& loop)
{
  Index taken = 0;
  for (std::size_t i = 0; i < shares_.size(); ++i)
  {
    taken += takeFrom((member + i) % shares_.size(), loop);
  }
  return taken;
}

// A share whose ticket is of an older loop has not been touched. As long as it has pieces of this
// loop left the loop is not over, so what is known of it holds; afterwards there is nothing to
// take. Half of what is left is taken at once: few tickets, and still something for who is early.
Index ThreadTeam::takeFrom(std::size_t share, const Loop& loop)
{
  std::atomic<std::uint64_t>& ticket = shares_[share].ticket;
  const std::uint64_t here = loop.number / 2 % kLoops;
  const Index begin = shareBegin(share, loop.pieces), end = shareBegin(share + 1, loop.pieces);
  Index taken = 0;
  std::uint64_t seen = ticket.load(std::memory_order_relaxed);
  for (;;)
  {
    const std::uint64_t ahead = ((seen >> kPieceBits) - here) % kLoops;
    const Index next = ahead == 0 ? static_cast<Index>(seen & kMostPieces) : begin;
    if ((ahead > 0 && ahead < kLoops / 2) || next >= end)
    {
      return taken;
    }
    const Index after = next + (end - next + 1) / 2;
    const std::uint64_t wanted = here << kPieceBits | static_cast<std::uint64_t>(after);
    if (ticket.compare_exchange_weak(seen, wanted, std::memory_order_acq_rel,
                                     std::memory_order_relaxed))
    {
      call(loop, next, after);
      taken += after - next;
      seen = wanted;
    }
  }
}

void ThreadTeam::call(const Loop& loop, Index begin, Index end)
{
  const bool was_in_loop = std::exchange(in_loop, true);
  for (Index piece = begin; piece < end; ++piece)
  {
    try
    {
      loop.function(loop.context, piece);
    }
    catch (...)
    {
      const std::lock_guard<std::mutex> lock(error_mutex_);
      error_ = error_ ? error_ : std::current_exception();
    }
  }
  in_loop = was_in_loop;
}

}  // namespace soft_tissue
