#include "soft_tissue_sim/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "soft_tissue_sim/base/error.h"
#include "thread_team.h"

namespace soft_tissue
{
namespace
{
std::atomic<int> g_threads{1};
std::unique_ptr<ThreadTeam> g_team;
}  // namespace

void setThreadCount(int threads)
{
  if (threads < 1)
  {
    throw Error("threads = " + std::to_string(threads) + ", must be at least 1");
  }
  if (threads == g_threads)
  {
    return;
  }
  g_team = threads > 1 ? std::make_unique<ThreadTeam>(threads) : nullptr;
  g_threads = threads;
}

int threadCount()
{
  return g_threads;
}

int usualThreadCount()
{
  constexpr unsigned kMost = 8;
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, kMost));
}

namespace detail
{
void runChunks(Index chunks, ChunkFunction function, const void* context)
{
  if (g_threads == 1 || chunks <= 1)
  {
    for (Index chunk = 0; chunk < chunks; ++chunk)
    {
      function(context, chunk);
    }
    return;
  }
  g_team->run(chunks, function, context);
}
}  // namespace detail

}  // namespace soft_tissue
