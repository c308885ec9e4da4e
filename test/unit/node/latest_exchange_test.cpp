#include "soft_tissue_sim/node/latest_exchange.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

namespace soft_tissue_sim
{
namespace
{
std::chrono::steady_clock::time_point soon()
{
  return std::chrono::steady_clock::now() + std::chrono::milliseconds(5);
}

std::chrono::steady_clock::time_point late()
{
  return std::chrono::steady_clock::now() + std::chrono::seconds(30);
}

TEST(LatestExchange, handsOverTheNewestOnce)
{
  LatestExchange<int> exchange;
  EXPECT_FALSE(exchange.acquire(soon()));
  for (int value : {1, 2, 3})
  {
    exchange.back() = value;
    exchange.publish();
  }
  ASSERT_TRUE(exchange.acquire(late()));
  EXPECT_EQ(exchange.front(), 3);
  EXPECT_FALSE(exchange.acquire(soon()));
  EXPECT_EQ(exchange.front(), 3);
}

TEST(LatestExchange, wakeEndsTheWaitWithoutANewValue)
{
  LatestExchange<int> exchange;
  exchange.wake();
  EXPECT_FALSE(exchange.acquire(late()));
}

TEST(LatestExchange, readerNeverSeesAHalfWrittenValueOrGoesBack)
{
  constexpr int kLast = 20000;
  using Block = std::array<int, 64>;
  LatestExchange<Block> exchange;
  std::thread writer([&exchange] {
    for (int value = 1; value <= kLast; ++value)
    {
      exchange.back().fill(value);
      exchange.publish();
    }
  });
  int newest = 0;
  bool in_order = true;
  bool whole = true;
  while (newest < kLast && exchange.acquire(late()))
  {
    const Block& block = exchange.front();
    in_order = in_order && block[0] > newest;
    newest = block[0];
    for (const int value : block)
    {
      whole = whole && value == newest;
    }
  }
  writer.join();
  EXPECT_EQ(newest, kLast);
  EXPECT_TRUE(in_order);
  EXPECT_TRUE(whole);
}

}  // namespace
}  // namespace soft_tissue_sim
