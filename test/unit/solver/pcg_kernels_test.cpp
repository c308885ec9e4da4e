#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "soft_tissue_sim/solver/packed_rows.h"
#include "support/block_matrices.h"
#include "support/finite_difference.h"

namespace soft_tissue
{
namespace
{
using namespace test;

PackedRows<double> packed(const BlockMatrix& a)
{
  std::vector<Index> order(a.rows());
  std::iota(order.begin(), order.end(), 0);
  PackedRows<double> rows;
  rows.takePattern(a, order, order);
  rows.load(pcgKernels<double>(instructionSet()), a.values().data(), 0, a.rows());
  return rows;
}

/** Of nodes, with the number behind them that may be read, which is none. */
std::vector<double> withOneMore(const Points& points)
{
  std::vector<double> numbers(flat(points).begin(), flat(points).end());
  numbers.push_back(std::numeric_limits<double>::quiet_NaN());
  return numbers;
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

TEST(PcgProduct, IsTheDenseProduct)
{
  const BlockMatrix a = randomPositiveMatrix(37, 60, 1);
  const PackedRows<double> rows = packed(a);
  const Points x = randomPoints(37, 2);
  const Eigen::VectorXd expected = dense(a) * flat(x);
  for (const InstructionSet set : instructionSets())
  {
    Points y(37, Vec3::Constant(1e300));
    pcgKernels<double>(set).multiply(rows.view(), 0, 37, withOneMore(x).data(), y.data()->data());
    EXPECT_LT((flat(y) - expected).norm(), 1e-14 * expected.norm()) << name(set);
  }
}

TEST(PcgProduct, HasTheSameBitsOnEveryInstructionSet)
{
  const BlockMatrix a = randomPositiveMatrix(101, 300, 3);
  const PackedRows<double> rows = packed(a);
  const std::vector<double> x = withOneMore(randomPoints(101, 4));
  Points first(101);
  pcgKernels<double>(InstructionSet::baseline)
      .multiply(rows.view(), 0, 101, x.data(), first.data()->data());
  for (const InstructionSet set : instructionSets())
  {
    Points y(101);
    pcgKernels<double>(set).multiply(rows.view(), 0, 101, x.data(), y.data()->data());
    EXPECT_EQ(y, first) << name(set);
  }
}

TEST(PcgProduct, WritesItsRowsOnly)
{
  const BlockMatrix a = randomPositiveMatrix(20, 30, 5);
  const PackedRows<double> rows = packed(a);
  const Points x = randomPoints(20, 6);
  const Eigen::VectorXd expected = dense(a) * flat(x);
  for (const InstructionSet set : instructionSets())
  {
    Points y(20, Vec3::Constant(7.0));
    pcgKernels<double>(set).multiply(rows.view(), 5, 12, withOneMore(x).data(), y.data()->data());
    for (Index i = 0; i < 20; ++i)
    {
      const Vec3 row = i >= 5 && i < 12 ? Vec3(expected.segment<3>(3 * i)) : Vec3::Constant(7.0);
      EXPECT_LT((y[i] - row).norm(), 1e-13) << name(set) << " row " << i;
    }
  }
}

// Wide loads bring along what is not the block's, nor the row's: none of it may leak.
TEST(PcgProduct, IsNotTouchedByWhatStandsBesideItsBlocks)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BlockMatrix a = randomPositiveMatrix(8, 10, 7);
  std::fill(a.values().begin() + 9 * static_cast<long>(a.columns().size()), a.values().end(), nan);
  const PackedRows<double> rows = packed(a);
  const Points x = randomPoints(8, 8);
  const Eigen::VectorXd expected = dense(a) * flat(x);
  std::fill_n(a.block(a.diagonal(7)), 9, nan);
  const PackedRows<double> broken = packed(a);
  for (const InstructionSet set : instructionSets())
  {
    Points y(8);
    pcgKernels<double>(set).multiply(broken.view(), 0, 8, withOneMore(x).data(), y.data()->data());
    EXPECT_LT((flat(y).head(21) - expected.head(21)).norm(), 1e-14 * expected.norm()) << name(set);
    EXPECT_TRUE(std::isnan(y[7].sum()));
    pcgKernels<double>(set).multiply(rows.view(), 0, 8, withOneMore(x).data(), y.data()->data());
    EXPECT_LT((flat(y) - expected).norm(), 1e-14 * expected.norm()) << name(set);
  }
}

/** Every block of the packed matrix, as it is multiplied by, with what is beside it. */
template <typename Real>
std::vector<Real> packedValues(InstructionSet set, const Points& blocks,
                               const std::vector<Index>& sources)
{
  std::vector<Real> values(12 * sources.size(), Real(0));
  const auto end = static_cast<Index>(sources.size()), cut = end / 2 / 2 * 2;
  const PcgKernels<Real>& kernels = pcgKernels<Real>(set);
  kernels.pack(withOneMore(blocks).data(), sources.data(), 0, cut, values.data());
  kernels.pack(withOneMore(blocks).data(), sources.data(), cut, end, values.data());
  return values;
}

template <typename Real>
void expectPacked(const Points& blocks, const std::vector<Index>& sources)
{
  for (const InstructionSet set : instructionSets())
  {
    const std::vector<Real> values = packedValues<Real>(set, blocks, sources);
    for (std::size_t slot = 0; slot < sources.size(); ++slot)
    {
      for (int column = 0; column < 3; ++column)
      {
        const Real* at = values.data() + 24 * (slot / 2) + 4 * (slot % 2) + 8 * column;
        EXPECT_EQ(at[3], Real(0)) << name(set);
        for (int row = 0; row < 3; ++row)
        {
          const Index source = sources[slot];
          const double expected = source == kNoBlock ? 0.0
                                  : source >= 0      ? blocks[3 * source + column][row]
                                                     : blocks[3 * ~source + row][column];
          EXPECT_EQ(at[row], static_cast<Real>(expected)) << name(set) << " column " << slot;
        }
      }
    }
  }
}

TEST(PcgProduct, PacksBlocksAndTransposesTwoByTwo)
{
  const Points blocks = randomPoints(3 * 4, 9);
  const std::vector<Index> sources = {2, ~0, 3, kNoBlock, ~3, ~2, 0, 1};
  expectPacked<double>(blocks, sources);
  expectPacked<float>(blocks, sources);
}

/** Three groups of uneven size; the last nodes are in none. */
const std::vector<Index> kGroups = {0, 5, 22, 30};

Index groupOf(Index node)
{
  return static_cast<Index>(std::upper_bound(kGroups.begin(), kGroups.end(), node) -
                            kGroups.begin()) -
         1;
}

/** All passes once, from the same numbers, over two pieces that are no multiple of any width. */
template <typename Real>
std::vector<double> runPasses(InstructionSet set)
{
  constexpr Index kNodes = 37, kCut = 13;
  const PcgKernels<Real>& kernels = pcgKernels<Real>(set);
  const auto numbers = [](Index nodes, int each, unsigned seed) {
    std::vector<Real> values;
    for (const Vec3& p : randomPoints(nodes * each / 3 + 1, seed))
    {
      values.insert(values.end(), p.data(), p.data() + 3);
    }
    return values;
  };
  const std::vector<Real> inverse = numbers(kNodes, 9, 1), p = numbers(kNodes, 3, 2);
  std::vector<Real> d = numbers(kNodes, 3, 3), r = numbers(kNodes, 3, 4), q = numbers(kNodes, 3, 5);
  std::vector<Real> turned = p;
  std::vector<double> results;
  for (const Index begin : {Index{0}, kCut})
  {
    const Index end = begin == 0 ? kCut : kNodes;
    const PcgSums sums = kernels.advance(begin, end, inverse.data(), Real(0.3), p.data(), d.data(),
                                         r.data(), q.data());
    kernels.turn(begin, end, Real(0.7), q.data(), turned.data());
    results.insert(results.end(), {sums.rr, sums.rz});
  }
  std::vector<Index> group;
  for (Index node = 0; node < kNodes; ++node)
  {
    group.push_back(groupOf(node));
  }
  const std::vector<Real> arms = numbers(kNodes, 3, 6), dense = numbers(18 * 18 / 3 + 1, 3, 7);
  const NodeGroups<Real> groups = {kGroups.data(), group.data(), arms.data()};
  std::vector<Real> gathered(18), moved(25, Real(0)), spread = p;
  kernels.gather(groups, 0, 2, r.data(), gathered.data());
  kernels.gather(groups, 2, 3, r.data(), gathered.data());
  kernels.multiplyDense(18, 0, 7, dense.data(), gathered.data(), moved.data());
  kernels.multiplyDense(18, 7, 18, dense.data(), gathered.data(), moved.data());
  kernels.spread(groups, 0, kCut, moved.data(), spread.data());
  kernels.spread(groups, kCut, kNodes, moved.data(), spread.data());
  for (const std::vector<Real>* vector : {&d, &r, &q, &turned, &spread})
  {
    results.insert(results.end(), vector->begin(), vector->begin() + 3 * kNodes);
  }
  results.insert(results.end(), gathered.begin(), gathered.end());
  results.insert(results.end(), moved.begin(), moved.begin() + 18);
  return results;
}

TEST(PcgPasses, DoWhatTheirFormulasSayInBothPrecisions)
{
  constexpr Index kNodes = 37;
  const Points blocks = randomPoints(3 * kNodes + 1, 1), p = randomPoints(kNodes + 1, 2),
               d = randomPoints(kNodes + 1, 3), r = randomPoints(kNodes + 1, 4),
               q = randomPoints(kNodes + 1, 5);
  const std::vector<double> in_double = runPasses<double>(instructionSet());
  const std::vector<double> in_float = runPasses<float>(instructionSet());
  double rr = 0.0, rz = 0.0;
  const auto expectAt = [&](std::size_t place, const Vec3& expected) {
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(in_double[place + k], expected[k], 1e-14);
      EXPECT_NEAR(in_float[place + k], expected[k], 1e-6);
    }
  };
  for (Index i = 0; i < kNodes; ++i)
  {
    const Mat3 inverse = Eigen::Map<const Mat3>(blocks[3 * i].data());
    const Vec3 residual = r[i] - 0.3 * q[i], z = inverse * residual;
    expectAt(4 + 3 * i, d[i] + 0.3 * p[i]);
    expectAt(4 + 3 * (kNodes + i), residual);
    expectAt(4 + 3 * (2 * kNodes + i), z);
    expectAt(4 + 3 * (3 * kNodes + i), z + 0.7 * p[i]);
    rr += residual.squaredNorm();
    rz += residual.dot(z);
  }
  EXPECT_NEAR(in_double[0] + in_double[2], rr, 1e-13 * rr);
  EXPECT_NEAR(in_double[1] + in_double[3], rz, 1e-13 * rr);
  EXPECT_NEAR(in_float[0] + in_float[2], rr, 1e-5 * rr);
  EXPECT_NEAR(in_float[1] + in_float[3], rz, 1e-5 * rr);
}

TEST(PcgPasses, MoveGroupsAsTheirFormulasSay)
{
  constexpr Index kNodes = 37;
  const Points p = randomPoints(kNodes + 1, 2), r0 = randomPoints(kNodes + 1, 4),
               q = randomPoints(kNodes + 1, 5), arms = randomPoints(kNodes + 1, 6),
               dense = randomPoints(18 * 18 / 3 + 2, 7);
  const std::vector<double> in_double = runPasses<double>(instructionSet());
  const std::vector<double> in_float = runPasses<float>(instructionSet());
  Eigen::VectorXd gathered = Eigen::VectorXd::Zero(24);
  for (Index i = 0; i < kNodes; ++i)
  {
    const Vec3 residual = r0[i] - 0.3 * q[i];
    gathered.segment<3>(6 * groupOf(i)) += residual;
    gathered.segment<3>(6 * groupOf(i) + 3) += arms[i].cross(residual);
  }
  const Eigen::Map<const Eigen::MatrixXd> matrix(dense[0].data(), 18, 18);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(24);
  moved.head(18) = matrix * gathered.head(18);
  const std::size_t spread = 4 + 3 * 4 * kNodes, after = spread + 3 * kNodes;
  for (Index i = 0; i < kNodes; ++i)
  {
    const Index g = groupOf(i);
    const Vec3 turn = moved.segment<3>(6 * g + 3);
    const Vec3 expected = p[i] + moved.segment<3>(6 * g) + turn.cross(arms[i]);
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(in_double[spread + 3 * i + k], expected[k], 1e-12);
      EXPECT_NEAR(in_float[spread + 3 * i + k], expected[k], 2e-4);
    }
  }
  for (int k = 0; k < 18; ++k)
  {
    EXPECT_NEAR(in_double[after + k], gathered[k], 1e-13);
    EXPECT_NEAR(in_double[after + 18 + k], moved[k], 1e-12);
    EXPECT_NEAR(in_float[after + 18 + k], moved[k], 1e-4);
  }
}

TEST(PcgPasses, HaveTheSameBitsOnEveryInstructionSet)
{
  for (const InstructionSet set : instructionSets())
  {
    EXPECT_EQ(runPasses<float>(set), runPasses<float>(InstructionSet::baseline)) << name(set);
    EXPECT_EQ(runPasses<double>(set), runPasses<double>(InstructionSet::baseline)) << name(set);
  }
}

}  // namespace
}  // namespace soft_tissue
