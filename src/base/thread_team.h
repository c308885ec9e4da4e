#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "soft_tissue_sim/base/parallel.h"

namespace soft_tissue
{
/**
 * Threads that help with short parallel loops, tens of microseconds each, many in a row: between two
 * of them a helper looks for the next one for a while before it sleeps, and nobody waits for a
 * helper that comes late.
 */
class ThreadTeam
{
 public:
  explicit ThreadTeam(int helpers);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /**
   * Calls function(context, chunk) for all chunks, on the caller's thread and the helpers'. Calls
   * from a second thread meanwhile, or from within, run on their own thread alone.
   * @throws what the function throws first, after all chunks have been tried
   */
  void run(Index chunks, detail::ChunkFunction function, const void* context);

 private:
  void help();
  bool runChunk();
  bool waitForLoop(std::uint64_t seen);

  // The loop at work. next_ holds its number in the upper half and the next chunk in the lower: a
  // chunk is claimed only while the loop is not finished, and what describes it then holds still.
  std::atomic<std::uint64_t> next_{0};
  std::atomic<std::uint32_t> chunks_{0};
  std::atomic<detail::ChunkFunction> function_{nullptr};
  std::atomic<const void*> context_{nullptr};
  std::atomic<std::uint32_t> done_{0};
  std::exception_ptr error_;
  std::mutex error_mutex_;

  std::mutex callers_;
  std::mutex sleep_mutex_;
  std::condition_variable woken_;
  std::atomic<int> sleepers_{0};
  std::atomic<bool> ending_{false};
  std::vector<std::thread> threads_;
};

}  // namespace soft_tissue
