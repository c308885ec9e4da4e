#include "soft_tissue_sim/energy/block_matrix.h"

#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** Two tets that share a face, and a node on its own. */
Adjacency pattern()
{
  return nodeNeighbours(6, {{0, 2, 3, 5}, {2, 5, 3, 1}});
}

TEST(BlockMatrix, HoldsNeighboursAndTheDiagonal)
{
  const BlockMatrix a(pattern());
  ASSERT_EQ(a.rows(), 6);
  for (Index row = 0; row < 6; ++row)
  {
    for (Index column = 0; column < 6; ++column)
    {
      const bool apart =
          row == 4 || column == 4 || (row == 0 && column == 1) || (row == 1 && column == 0);
      EXPECT_EQ(a.find(row, column) >= 0, row == column || !apart) << row << ", " << column;
    }
    EXPECT_EQ(a.find(row, row), a.diagonal(row));
  }
}

TEST(BlockMatrix, KnowsWhereABlocksTransposeStands)
{
  const BlockMatrix a(pattern());
  for (Index row = 0; row < 6; ++row)
  {
    for (Index k = a.offsets()[row]; k <= a.diagonal(row); ++k)
    {
      EXPECT_EQ(a.mirror(k), a.find(a.columns()[k], row)) << row << ", " << a.columns()[k];
    }
  }
}

TEST(BlockMatrix, KeepsBlocksOutsideItsPatternAsCouplings)
{
  BlockMatrix a(pattern());
  const Mat3 b = Mat3::Random();
  a.add(0, 1, b);
  a.add(3, 4, Mat3::Identity());
  a.add(0, 1, 2.0 * b);
  a.add(0, 2, b);
  ASSERT_EQ(a.couplings().size(), 2u);
  EXPECT_EQ(a.couplings()[0].row, 0);
  EXPECT_EQ(a.couplings()[0].column, 1);
  EXPECT_EQ(a.couplings()[0].block, b + 2.0 * b);
  EXPECT_EQ(a.couplings()[1].block, Mat3::Identity());
  EXPECT_EQ(Eigen::Map<const Mat3>(a.block(a.find(0, 2))), b);
  a.setZero();
  EXPECT_TRUE(a.couplings().empty());
  a.add(0, 1, b);
  EXPECT_EQ(a.couplings().at(0).block, b);
}

TEST(BlockMatrix, KeepsOuterProductsUntilSetToZero)
{
  BlockMatrix a(pattern());
  Adjacency nodes;
  nodes.offsets = {0, 2, 3};
  nodes.items = {0, 4, 3};
  EXPECT_EQ(a.outer().append(nodes), 0);
  EXPECT_EQ(a.outer().append(nodes), 2);
  EXPECT_EQ(a.outer().size(), 4);
  EXPECT_EQ(a.outer().offsets(), (std::vector<Index>{0, 2, 3, 5, 6}));
  EXPECT_EQ(a.outer().nodes(), (std::vector<Index>{0, 4, 3, 0, 4, 3}));
  a.outer().vector(3)[1] = 5.0;
  a.outer().weights()[2] = 2.0;
  a.setZero();
  EXPECT_TRUE(a.outer().empty());
  a.outer().append(nodes);
  a.outer().append(nodes);
  EXPECT_EQ(a.outer().vector(3)[1], 0.0);
  EXPECT_EQ(a.outer().weights()[2], 0.0);
}

TEST(BlockMatrix, RefusesABlockBelowTheDiagonal)
{
  BlockMatrix a(pattern());
  try
  {
    a.add(1, 0, Mat3::Identity());
    FAIL() << "added";
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(), "block (1, 0) is below the diagonal");
  }
}

}  // namespace
}  // namespace soft_tissue
