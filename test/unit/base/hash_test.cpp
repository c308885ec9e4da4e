#include "soft_tissue_sim/base/hash.h"

#include <gtest/gtest.h>

#include <bitset>
#include <set>
#include <string>
#include <vector>

namespace soft_tissue
{
namespace
{
std::uint64_t hashOf(const std::vector<std::string>& records)
{
  StateHash hash;
  for (const std::string& record : records)
  {
    hash.add(record.data(), record.size());
  }
  return hash.value();
}

TEST(StateHash, equalStatesGiveEqualValues)
{
  EXPECT_EQ(hashOf({"liver", "probe"}), hashOf({"liver", "probe"}));
}

TEST(StateHash, aValueIsItsBytes)
{
  const double value = 0.1;
  StateHash one, other;
  one.addValue(value);
  other.add(&value, sizeof(value));
  EXPECT_EQ(one.value(), other.value());
}

TEST(StateHash, askingDoesNotChangeIt)
{
  StateHash asked, plain;
  asked.addValue(1);
  asked.value();
  asked.addValue(2);
  plain.addValue(1);
  plain.addValue(2);
  EXPECT_EQ(asked.value(), asked.value());
  EXPECT_EQ(asked.value(), plain.value());
}

TEST(StateHash, everyBitOfEveryByteCounts)
{
  for (std::size_t size = 1; size <= 75; ++size)
  {
    const std::string zero(size, '\0');
    std::set<std::uint64_t> values = {hashOf({zero})};
    for (std::size_t byte = 0; byte < size; ++byte)
    {
      for (int bit = 0; bit < 8; ++bit)
      {
        std::string flipped = zero;
        flipped[byte] = static_cast<char>(1 << bit);
        EXPECT_TRUE(values.insert(hashOf({flipped})).second)
            << "bit " << bit << " of byte " << byte << " of " << size;
      }
    }
  }
}

TEST(StateHash, oneBitChangesHalfOfTheValue)
{
  int changed = 0;
  const std::uint64_t zero = hashOf({std::string(64, '\0')});
  for (std::size_t bit = 0; bit < 512; ++bit)
  {
    std::string flipped(64, '\0');
    flipped[bit / 8] = static_cast<char>(1 << (bit % 8));
    changed += static_cast<int>(std::bitset<64>(zero ^ hashOf({flipped})).count());
  }
  // 512 x 64 fair coins: mean 16384, standard deviation 91.
  EXPECT_NEAR(changed, 16384, 5 * 91);
}

TEST(StateHash, orderAndLengthCount)
{
  EXPECT_NE(hashOf({"a", "b"}), hashOf({"b", "a"}));
  EXPECT_NE(hashOf({}), hashOf({""}));
  EXPECT_NE(hashOf({std::string(1, '\0')}), hashOf({std::string(2, '\0')}));
  EXPECT_NE(hashOf({"same"}), hashOf({"same", "same"}));
}

TEST(StateHash, signOfZeroCounts)
{
  StateHash plus, minus;
  plus.addValue(0.0);
  minus.addValue(-0.0);
  EXPECT_NE(plus.value(), minus.value());
}

TEST(StateHash, manyStatesDoNotCollide)
{
  std::set<std::uint64_t> values;
  for (int i = 0; i < 100000; ++i)
  {
    StateHash hash;
    hash.addValue(i);
    EXPECT_TRUE(values.insert(hash.value()).second) << i;
  }
}

}  // namespace
}  // namespace soft_tissue
