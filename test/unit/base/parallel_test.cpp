#include "soft_tissue_sim/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
using Piece = std::pair<Index, Index>;

/** Every thread count a test is repeated for; the process is left with one thread. */
class Parallel : public testing::TestWithParam<int>
{
 protected:
  void SetUp() override { setThreadCount(GetParam()); }
  void TearDown() override { setThreadCount(1); }
};

/** The pieces the documentation promises: `grain` items each, the last one shorter. */
std::vector<Piece> documentedPieces(Index count, Index grain)
{
  std::vector<Piece> pieces;
  for (Index begin = 0; begin < count; begin += grain)
  {
    pieces.emplace_back(begin, std::min(begin + grain, count));
  }
  return pieces;
}

/** Terms of very different size and sign: their sum depends on the order of adding. */
double term(Index i)
{
  return (i % 3 == 0 ? 1.0e16 : i % 3 == 1 ? -1.0e16 : 1.0) * std::sin(1.0 + i);
}

double sumOfTerms(Index begin, Index end)
{
  double sum = 0.0;
  for (Index i = begin; i < end; ++i)
  {
    sum += term(i);
  }
  return sum;
}

bool sameBits(double a, double b)
{
  return std::memcmp(&a, &b, sizeof(double)) == 0;
}

TEST_P(Parallel, piecesAreTheDocumentedOnes)
{
  for (const Index count : {1, 2, 63, 64, 65, 1000})
  {
    for (const Index grain : {1, 7, 64, 2000})
    {
      const std::vector<Piece> expected = documentedPieces(count, grain);
      std::vector<Piece> pieces(expected.size(), Piece(-1, -1));
      std::atomic<int> calls{0};
      parallelFor(count, grain, [&](Index begin, Index end) {
        pieces.at(static_cast<std::size_t>(begin / grain)) = Piece(begin, end);
        ++calls;
      });
      EXPECT_EQ(pieces, expected) << count << " items in pieces of " << grain;
      EXPECT_EQ(calls, static_cast<int>(expected.size()));
    }
  }
}

TEST_P(Parallel, emptyRangeCallsNothing)
{
  int calls = 0;
  parallelFor(0, 8, [&](Index, Index) { ++calls; });
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(parallelSum(0, 8, [&](Index, Index) { return ++calls, 1.0; }), 0.0);
  EXPECT_EQ(calls, 0);
}

TEST_P(Parallel, sumAddsThePiecesInTheirOrder)
{
  for (const Index count : {1, 10, 1000, 255 * 16, 256 * 16})
  {
    double expected = 0.0;
    for (const Piece& piece : documentedPieces(count, 16))
    {
      expected += sumOfTerms(piece.first, piece.second);
    }
    for (int run = 0; run < 20; ++run)
    {
      EXPECT_TRUE(sameBits(parallelSum(count, 16, sumOfTerms), expected)) << count << " terms";
    }
  }
}

TEST_P(Parallel, longSumsHaveAtMost256Pieces)
{
  for (const Index count : {257, 1000, 100003})
  {
    std::vector<std::atomic<int>> visits(static_cast<std::size_t>(count));
    std::atomic<int> pieces{0};
    const double sum = parallelSum(count, 1, [&](Index begin, Index end) {
      ++pieces;
      for (Index i = begin; i < end; ++i)
      {
        ++visits[static_cast<std::size_t>(i)];
      }
      return static_cast<double>(end - begin);
    });
    EXPECT_LE(pieces, 256);
    EXPECT_EQ(sum, count);
    for (const std::atomic<int>& visit : visits)
    {
      ASSERT_EQ(visit, 1);
    }
  }
}

TEST_P(Parallel, aLoopWithinALoopIsDoneWhole)
{
  std::atomic<int> calls{0};
  parallelFor(20, 1, [&](Index, Index) { parallelFor(30, 1, [&](Index, Index) { ++calls; }); });
  EXPECT_EQ(calls, 600);
}

TEST_P(Parallel, loopsOfSeveralThreadsAreDoneWhole)
{
  std::vector<std::thread> callers;
  std::vector<double> sums(4, 0.0);
  for (double& sum : sums)
  {
    callers.emplace_back([&sum] {
      for (int run = 0; run < 500; ++run)
      {
        sum += parallelSum(100, 3, [](Index begin, Index end) { return end - begin; });
      }
    });
  }
  for (std::thread& caller : callers)
  {
    caller.join();
  }
  EXPECT_EQ(sums, std::vector<double>(4, 50000.0));
}

TEST_P(Parallel, loopsOfAllSizesFollowEachOther)
{
  std::vector<int> visits;
  for (int run = 0; run < 20000; ++run)
  {
    const Index count = run * 7919 % 37;
    visits.assign(count, 0);
    parallelFor(count, 1, [&](Index begin, Index) { ++visits[begin]; });
    ASSERT_EQ(std::count(visits.begin(), visits.end(), 1), count) << "run " << run;
    if (run % 2000 == 0)  // threads that wait go to sleep
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
}

TEST_P(Parallel, anErrorComesOut)
{
  for (int run = 0; run < 100; ++run)
  {
    EXPECT_THROW(parallelFor(40, 1,
                             [&](Index begin, Index) {
                               if (begin % 10 == 7)
                               {
                                 throw Error("piece " + std::to_string(begin));
                               }
                             }),
                 Error);
    EXPECT_EQ(parallelSum(40, 1, [](Index, Index) { return 1; }), 40) << "loops go on";
  }
}

INSTANTIATE_TEST_SUITE_P(ThreadCounts, Parallel, testing::Values(1, 2, 3, 8));

TEST(ParallelSum, theTermsUsedHereFeelTheOrderOfAdding)
{
  double backwards = 0.0;
  for (Index i = 1000; i-- > 0;)
  {
    backwards += term(i);
  }
  EXPECT_FALSE(sameBits(backwards, sumOfTerms(0, 1000)));
}

TEST(ThreadCount, isWhatWasSet)
{
  setThreadCount(3);
  EXPECT_EQ(threadCount(), 3);
  setThreadCount(1);
  EXPECT_EQ(threadCount(), 1);
}

TEST(ThreadCount, isUsuallyThatOfProcessorsUpToEight)
{
  EXPECT_GE(usualThreadCount(), 1);
  EXPECT_LE(usualThreadCount(), 8);
  EXPECT_LE(usualThreadCount(), std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
}

TEST(ThreadCount, belowOneIsAnError)
{
  for (const int threads : {0, -4})
  {
    try
    {
      setThreadCount(threads);
      FAIL() << "accepted " << threads;
    }
    catch (const Error& error)
    {
      EXPECT_EQ(std::string(error.what()),
                "threads = " + std::to_string(threads) + ", must be at least 1");
    }
    EXPECT_EQ(threadCount(), 1);
  }
}

}  // namespace
}  // namespace soft_tissue
