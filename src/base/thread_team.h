#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
/**
 * Threads that wait for short loops: each loop's pieces are dealt out in as many shares as there
 * are threads, and who is done with its share takes from the others'. Nobody is waited for who does
 * not come. A thread looks for the next loop for a while before it sleeps.
 */
class ThreadTeam
{
 public:
  /**
   * @param threads  the caller's among them, >= 1
   * @throws Error if the system has no more threads
   */
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /**
   * Calls the function for each of the pieces, and returns when all are done. Loops within loops,
   * and those of a second caller meanwhile, are done by their caller alone.
   * @throws what one of the calls threw, after the others are done
   */
  void run(Index pieces, detail::ChunkFunction function, const void* context);

 private:
  static constexpr std::size_t kApart = 128;  ///< bytes; caches fetch lines by twos

  struct Loop
  {
    std::uint64_t number = 0;
    Index pieces = 0;
    detail::ChunkFunction function = nullptr;
    const void* context = nullptr;
  };
  /** Of which loop somebody last took pieces of a share, and which one comes next. */
  struct alignas(kApart) Share
  {
    std::atomic<std::uint64_t> ticket{0};
  };

  void end();
  void open(Index pieces, detail::ChunkFunction function, const void* context);
  bool look(Loop& loop) const;
  void work(std::size_t member);
  bool waitForLoop(std::uint64_t seen);
  Index takeAll(std::size_t member, const Loop& loop);
  Index takeFrom(std::size_t share, const Loop& loop);
  void call(const Loop& loop, Index begin, Index end);
  Index shareBegin(std::size_t share, Index pieces) const;

  // What a loop is, in one line of the cache. An odd number: it is being written.
  alignas(kApart) std::atomic<std::uint64_t> number_{0};
  std::atomic<Index> pieces_{0};
  std::atomic<detail::ChunkFunction> function_{nullptr};
  std::atomic<const void*> context_{nullptr};
  std::atomic<bool> ending_{false};

  alignas(kApart) std::atomic<std::uint64_t> done_{
      0};  ///< pieces that others than callers did, ever
  alignas(kApart) std::vector<Share> shares_;
  std::uint64_t given_ = 0;  ///< pieces that others than callers took, ever
  std::mutex in_use_;
  std::mutex error_mutex_;
  std::exception_ptr error_;
  std::atomic<int> sleepers_{0};
  std::mutex sleep_mutex_;
  std::condition_variable wake_;
  std::vector<std::thread> threads_;
};

}  // namespace soft_tissue
