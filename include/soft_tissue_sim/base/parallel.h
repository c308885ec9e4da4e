#pragma once

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * Threads that parallel loops may use, process wide. Results never depend on it. Not while a loop
 * runs.
 * @throws Error below 1, or if the system has no more threads
 */
void setThreadCount(int threads);
int threadCount();
/** One per processor, 8 at most: loops of some ten microseconds have no work for more. */
int usualThreadCount();

namespace detail
{
using ChunkFunction = void (*)(const void* context, Index chunk);
void runChunks(Index chunks, ChunkFunction function, const void* context);
constexpr Index kMaxSumChunks = 256;
inline Index chunkCount(Index count, Index grain)
{
  return (count + grain - 1) / grain;
}
}  // namespace detail

/**
 * Calls body(begin, end) for consecutive pieces of [0, count), `grain` items each, possibly at once
 * on several threads. The pieces depend on count and grain only. Allocates nothing in a steady
 * state.
 */
template <typename Body>
void parallelFor(Index count, Index grain, const Body& body)
{
  struct Context
  {
    const Body* body;
    Index count, grain;
  } const context{&body, count, grain};
  detail::runChunks(
      detail::chunkCount(count, grain),
      [](const void* data, Index chunk) {
        const Context& c = *static_cast<const Context*>(data);
        const Index begin = chunk * c.grain;
        (*c.body)(begin, begin + c.grain < c.count ? begin + c.grain : c.count);
      },
      &context);
}

/** Calls f(i) for all i of [begin, end), `grain` of them one after the other. */
template <typename Function>
void parallelForEach(Index begin, Index end, Index grain, const Function& f)
{
  parallelFor(end - begin, grain, [&](Index first, Index last) {
    for (Index i = begin + first; i < begin + last; ++i)
    {
      f(i);
    }
  });
}

/** Grain of loops over nodes: cut alike, each thread keeps to its own nodes in all of them. */
constexpr Index kNodeGrain = 64;

/**
 * Sum of body(begin, end) over such pieces, numbers or what `{}` makes zero and += adds, in their
 * order: the same bits for any thread count. At most 256 pieces: the grain is enlarged for longer
 * ranges.
 */
template <typename Body>
auto parallelSum(Index count, Index grain, const Body& body) -> decltype(body(Index{}, Index{}))
{
  using Sum = decltype(body(Index{}, Index{}));
  if (detail::chunkCount(count, grain) > detail::kMaxSumChunks)
  {
    grain = detail::chunkCount(count, detail::kMaxSumChunks);
  }
  std::array<Sum, detail::kMaxSumChunks> partial;
  Sum* sums = partial.data();
  parallelFor(count, grain, [&body, sums, grain](Index begin, Index end) {
    sums[begin / grain] = body(begin, end);
  });
  Sum sum{};
  for (Index chunk = 0; chunk < detail::chunkCount(count, grain); ++chunk)
  {
    sum += sums[chunk];
  }
  return sum;
}

}  // namespace soft_tissue
