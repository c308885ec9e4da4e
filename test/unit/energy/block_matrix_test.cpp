#include "soft_tissue_sim/energy/block_matrix.h"

#include <gtest/gtest.h>

#include <random>

#include "soft_tissue_sim/base/error.h"
#include "support/finite_difference.h"

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

TEST(BlockMatrix, MirrorsItsUpperBlocks)
{
  BlockMatrix a(pattern());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (double& value : a.values())
  {
    value = uniform(random);
  }
  const Eigen::MatrixXd before = test::dense(a);
  a.mirrorUpper();
  const Eigen::MatrixXd after = test::dense(a);
  for (Index row = 0; row < 6; ++row)
  {
    for (Index column = 0; column < 6; ++column)
    {
      Mat3 expected = before.block<3, 3>(3 * row, 3 * column);
      if (row > column)
      {
        expected = before.block<3, 3>(3 * column, 3 * row).transpose();
      }
      EXPECT_EQ((after.block<3, 3>(3 * row, 3 * column)), expected) << row << ", " << column;
    }
  }
}

TEST(BlockMatrix, RefusesABlockOutsideItsPattern)
{
  BlockMatrix a(pattern());
  try
  {
    a.add(0, 1, Mat3::Identity());
    FAIL() << "added";
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(), "block (0, 1) is not in the matrix's pattern");
  }
}

}  // namespace
}  // namespace soft_tissue
