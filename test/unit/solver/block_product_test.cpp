#include "soft_tissue_sim/solver/block_product.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/block_matrices.h"
#include "support/finite_difference.h"

namespace soft_tissue
{
namespace
{
using namespace test;

BlockRows rowsOf(const BlockMatrix& a)
{
  return {a.offsets().data(), a.columns().data(), a.values().data()};
}

std::vector<InstructionSet> instructionSets()
{
  std::vector<InstructionSet> sets;
  for (int set = 0; set <= static_cast<int>(instructionSet()); ++set)
  {
    sets.push_back(static_cast<InstructionSet>(set));
  }
  return sets;
}

TEST(BlockProduct, IsTheDenseProduct)
{
  const BlockMatrix a = randomPositiveMatrix(37, 60, 1);
  const Points x = randomPoints(37, 2);
  const Eigen::VectorXd expected = dense(a) * flat(x);
  for (const InstructionSet set : instructionSets())
  {
    Points y(37, Vec3::Constant(1e300));
    blockProduct(set)(rowsOf(a), 0, 37, x.data()->data(), y.data()->data());
    EXPECT_LT((flat(y) - expected).norm(), 1e-14 * expected.norm()) << name(set);
  }
}

TEST(BlockProduct, HasTheSameBitsOnEveryInstructionSet)
{
  const BlockMatrix a = randomPositiveMatrix(101, 300, 3);
  const Points x = randomPoints(101, 4);
  Points first(101);
  blockProduct(InstructionSet::baseline)(rowsOf(a), 0, 101, x.data()->data(), first.data()->data());
  for (const InstructionSet set : instructionSets())
  {
    Points y(101);
    blockProduct(set)(rowsOf(a), 0, 101, x.data()->data(), y.data()->data());
    EXPECT_EQ(y, first) << name(set);
  }
}

TEST(BlockProduct, WritesItsRowsOnly)
{
  const BlockMatrix a = randomPositiveMatrix(20, 30, 5);
  const Points x = randomPoints(20, 6);
  const Eigen::VectorXd expected = dense(a) * flat(x);
  for (const InstructionSet set : instructionSets())
  {
    Points y(20, Vec3::Constant(7.0));
    blockProduct(set)(rowsOf(a), 5, 12, x.data()->data(), y.data()->data());
    for (Index i = 0; i < 20; ++i)
    {
      const Vec3 row = i >= 5 && i < 12 ? Vec3(expected.segment<3>(3 * i)) : Vec3::Constant(7.0);
      EXPECT_LT((y[i] - row).norm(), 1e-13) << name(set) << " row " << i;
    }
  }
}

// The fourth lane of the wide loads holds the next block's numbers: none of it may leak.
TEST(BlockProduct, IsNotTouchedByWhatStandsBesideItsBlocks)
{
  BlockMatrix a = randomPositiveMatrix(8, 10, 7);
  const Points x = randomPoints(8, 8);
  const Eigen::VectorXd expected = dense(a) * flat(x);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::fill(a.values().begin() + 9 * static_cast<long>(a.columns().size()), a.values().end(), nan);
  const Index last = a.offsets()[7];
  for (const InstructionSet set : instructionSets())
  {
    Points y(8);
    blockProduct(set)(rowsOf(a), 0, 8, x.data()->data(), y.data()->data());
    EXPECT_LT((flat(y) - expected).norm(), 1e-14 * expected.norm()) << name(set);

    BlockMatrix broken = a;
    std::fill_n(broken.block(last), 9, nan);
    blockProduct(set)(rowsOf(broken), 0, 7, x.data()->data(), y.data()->data());
    EXPECT_LT((flat(y).head(21) - expected.head(21)).norm(), 1e-14 * expected.norm()) << name(set);
  }
}

}  // namespace
}  // namespace soft_tissue
