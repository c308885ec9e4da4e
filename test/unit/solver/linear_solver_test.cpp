#include "soft_tissue_sim/solver/linear_solver.h"

#include <gtest/gtest.h>

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "support/block_matrices.h"
#include "support/finite_difference.h"

namespace soft_tissue
{
namespace
{
using namespace test;

using MakeSolver = std::unique_ptr<LinearSolver> (*)();

struct SolverCase
{
  const char* name;
  MakeSolver make;
};

/** What all linear solvers have to keep. */
class EveryLinearSolver : public ::testing::TestWithParam<SolverCase>
{
 protected:
  std::unique_ptr<LinearSolver> solver_ = GetParam().make();
};

INSTANTIATE_TEST_SUITE_P(All, EveryLinearSolver,
                         ::testing::Values(SolverCase{"pcg", makePcg},
                                           SolverCase{"cholesky", makeCholesky},
                                           SolverCase{"automatic", makeAutomatic}),
                         [](const auto& info) { return std::string(info.param.name); });

/** Where the nodes of a matrix may stand, m. */
Points placesOf(const BlockMatrix& a)
{
  return randomPoints(a.rows(), 1000);
}

double relativeResidual(const BlockMatrix& a, const Points& b, const Points& d)
{
  return (flat(b) - dense(a) * flat(d)).norm() / flat(b).norm();
}

TEST_P(EveryLinearSolver, FindsTheDenseSolution)
{
  for (unsigned seed = 0; seed < 10; ++seed)
  {
    const Index rows = 20 + 7 * static_cast<Index>(seed);
    const BlockMatrix a = randomPositiveMatrix(rows, 3 * rows, seed);
    const Points b = randomPoints(rows, seed + 100);
    const Eigen::MatrixXd whole = dense(a);
    const Eigen::VectorXd exact = whole.ldlt().solve(flat(b));
    Points d;
    const LinearReport report = solveWith(*solver_, a, b, placesOf(a), 1e-12, d);
    EXPECT_FALSE(report.indefinite);
    EXPECT_GT(report.iterations, 0);
    ASSERT_EQ(d.size(), b.size());
    EXPECT_LT(relativeResidual(a, b, d), 1.01e-12);
    const auto eigenvalues = whole.selfadjointView<Eigen::Lower>().eigenvalues();
    const double condition = eigenvalues.maxCoeff() / eigenvalues.minCoeff();
    EXPECT_LT((flat(d) - exact).norm(), 2e-12 * condition * exact.norm());
  }
}

TEST_P(EveryLinearSolver, KeepsToTheToleranceAskedFor)
{
  const BlockMatrix a = randomPositiveMatrix(150, 500, 21);
  const Points b = randomPoints(150, 22);
  for (const double tolerance : {0.1, 1e-2, 1e-4, 1e-8, 1e-11})
  {
    Points d = randomPoints(150, 23);  // what stood there before does not matter
    solveWith(*solver_, a, b, placesOf(a), tolerance, d);
    EXPECT_LT(relativeResidual(a, b, d), 1.01 * tolerance);
  }
}

TEST_P(EveryLinearSolver, AnswersNothingWithNothing)
{
  const BlockMatrix a = randomPositiveMatrix(10, 20, 31);
  Points d = randomPoints(10, 32);
  const LinearReport report =
      solveWith(*solver_, a, Points(10, Vec3::Zero()), placesOf(a), 1e-6, d);
  EXPECT_FALSE(report.indefinite);
  EXPECT_EQ(d, Points(10, Vec3::Zero()));
}

TEST_P(EveryLinearSolver, IsNotMisledByTheMatrixBefore)
{
  const Index rows = 40;
  const std::vector<BlockMatrix> matrices = {
      randomPositiveMatrix(rows, 90, 41),      // a first one
      randomPositiveMatrix(rows, 90, 41),      // its pattern with other numbers, made below
      randomPositiveMatrix(rows + 5, 90, 42),  // another size
      randomPositiveMatrix(rows, 70, 43),      // another number of blocks
  };
  for (std::size_t k = 0; k < matrices.size(); ++k)
  {
    BlockMatrix a = matrices[k];
    if (k == 1)
    {
      addRandomElements(randomTets(rows, 90, 41), 44, a);
    }
    const Points b = randomPoints(a.rows(), 45);
    Points d;
    solveWith(*solver_, a, b, placesOf(a), 1e-12, d);
    EXPECT_LT(relativeResidual(a, b, d), 1.01e-12) << "matrix " << k;
  }
}

TEST_P(EveryLinearSolver, CountsCouplingsOutsideThePatternWhichComeAndGo)
{
  const Index rows = 60;
  for (const int touching : {0, 3, 20, 7, 0})
  {
    BlockMatrix a = randomPositiveMatrix(rows, 60, 61);
    addRandomElements(randomTets(rows, touching, 62 + touching), 63, a);
    EXPECT_EQ(a.couplings().empty(), touching == 0);
    const Points b = randomPoints(rows, 64);
    for (const double tolerance : {1e-2, 1e-12})  // single and double precision
    {
      Points d;
      solveWith(*solver_, a, b, placesOf(a), tolerance, d);
      EXPECT_LT(relativeResidual(a, b, d), 1.01 * tolerance) << touching;
    }
  }
}

TEST_P(EveryLinearSolver, CountsOuterProductsWhichComeAndGo)
{
  const Index rows = 60;
  for (const int count : {0, 3, 20, 20, 7, 0})
  {
    for (const double weight : {1.0, 1e4})
    {
      BlockMatrix a = randomPositiveMatrix(rows, 100, 61);
      addRandomOuterProducts(count, 9, weight, 62 + count, a);
      addRandomOuterProducts(count / 2, 5, weight, 63, a);  // of another body
      const Points b = randomPoints(rows, 64);
      for (const double tolerance : {1e-2, 1e-10})  // single and double precision
      {
        Points d;
        EXPECT_FALSE(solveWith(*solver_, a, b, placesOf(a), tolerance, d).indefinite);
        EXPECT_LT(relativeResidual(a, b, d), 1.05 * tolerance) << count << " " << weight;
      }
    }
  }
}

TEST_P(EveryLinearSolver, TellsOuterProductsThatMakeAMatrixIndefinite)
{
  BlockMatrix a = randomPositiveMatrix(30, 80, 65);
  addRandomOuterProducts(8, 6, 1.0, 66, a);
  const Points b = randomPoints(30, 67);
  Points d;
  a.outer().weights()[2] = 0.0;  // allowed, and nothing
  a.outer().weights()[3] *= -1e-3;
  ASSERT_GT(smallestEigenvalue(dense(a)), 0.0);
  EXPECT_FALSE(solveWith(*solver_, a, b, placesOf(a), 1e-10, d).indefinite);
  EXPECT_LT(relativeResidual(a, b, d), 1.01e-10);
  a.outer().weights()[3] = -100.0;
  ASSERT_LT(smallestEigenvalue(dense(a)), 0.0);
  EXPECT_TRUE(solveWith(*solver_, a, b, placesOf(a), 1e-10, d).indefinite);
}

TEST_P(EveryLinearSolver, SeesAnotherPatternOfAsManyBlocks)
{
  // Four nodes and three couplings each: a chain and a star.
  const std::vector<std::vector<Edge>> graphs = {{{0, 1}, {1, 2}, {2, 3}},
                                                 {{0, 1}, {0, 2}, {0, 3}}};
  for (const std::vector<Edge>& edges : graphs)
  {
    std::vector<std::vector<Index>> others(4);
    for (const Edge& edge : edges)
    {
      others[edge[0]].push_back(edge[1]);
      others[edge[1]].push_back(edge[0]);
    }
    Adjacency neighbours;
    neighbours.offsets.push_back(0);
    for (const std::vector<Index>& row : others)
    {
      neighbours.items.insert(neighbours.items.end(), row.begin(), row.end());
      neighbours.offsets.push_back(static_cast<Index>(neighbours.items.size()));
    }
    BlockMatrix a(neighbours);
    Mat3 coupling;
    coupling << 0.1, 0.2, 0.3, -0.4, 0.5, 0.6, 0.7, -0.8, 0.9;
    for (const Edge& edge : edges)
    {
      a.add(edge[0], edge[1], coupling);
    }
    for (Index i = 0; i < 4; ++i)
    {
      addDiagonal(a, i, 5.0 + i);
    }
    const Points b = randomPoints(4, 51);
    Points d;
    EXPECT_FALSE(solveWith(*solver_, a, b, placesOf(a), 1e-12, d).indefinite);
    EXPECT_LT(relativeResidual(a, b, d), 1.01e-12);
  }
}

TEST_P(EveryLinearSolver, SaysWhenAMatrixIsIndefinite)
{
  for (const double pull : {-1e-2, -1.0, -100.0})
  {
    BlockMatrix a = randomPositiveMatrix(30, 80, 61);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(dense(a));
    // Shifts the lowest eigenvalue to `pull` and keeps most of the others positive.
    for (Index i = 0; i < 30; ++i)
    {
      addDiagonal(a, i, pull - eigen.eigenvalues()[0]);
    }
    const Points b = randomPoints(30, 62);
    Points d;
    EXPECT_TRUE(solveWith(*solver_, a, b, placesOf(a), 1e-10, d).indefinite) << pull;
    ASSERT_EQ(d.size(), b.size());
    EXPECT_TRUE(flat(d).allFinite());
    EXPECT_GE(flat(d).dot(flat(b)), 0.0) << "what is found until then leads down";
  }
}

TEST_P(EveryLinearSolver, SolvesASingularSystemThatHasASolution)
{
  BlockMatrix a = randomPositiveMatrix(12, 25, 71);
  const Index lone = 4;  // as a node in no element
  for (Index k = a.offsets()[lone]; k < a.offsets()[lone + 1]; ++k)
  {
    std::fill_n(a.block(k), 9, 0.0);
    std::fill_n(a.block(a.find(a.columns()[k], lone)), 9, 0.0);
  }
  Points b = randomPoints(12, 72);
  b[lone].setZero();
  Points d;
  EXPECT_FALSE(solveWith(*solver_, a, b, placesOf(a), 1e-10, d).indefinite);
  EXPECT_LT(relativeResidual(a, b, d), 1.01e-10);

  b[lone] = Vec3(0.0, 1.0, 0.0);
  EXPECT_TRUE(solveWith(*solver_, a, b, placesOf(a), 1e-10, d).indefinite)
      << "no solution, and nobody said so";
  EXPECT_TRUE(flat(d).allFinite());
}

TEST_P(EveryLinearSolver, DoesNotPassOffANumberFromNoNumber)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BlockMatrix a = randomPositiveMatrix(12, 25, 73);
  Points b = randomPoints(12, 74), d;
  b[3].y() = nan;
  LinearReport report = solveWith(*solver_, a, b, placesOf(a), 1e-10, d);
  EXPECT_TRUE(report.indefinite || !flat(d).allFinite()) << "right-hand side";
  a.block(a.diagonal(5))[4] = nan;
  report = solveWith(*solver_, a, randomPoints(12, 75), placesOf(a), 1e-10, d);
  EXPECT_TRUE(report.indefinite || !flat(d).allFinite()) << "matrix";
  // And is none the worse for it.
  a = randomPositiveMatrix(12, 25, 73);
  b = randomPoints(12, 76);
  EXPECT_FALSE(solveWith(*solver_, a, b, placesOf(a), 1e-10, d).indefinite);
  EXPECT_LT(relativeResidual(a, b, d), 1.01e-10);
}

TEST_P(EveryLinearSolver, HasTheSameBitsForAnyThreadsAndInstructionSet)
{
  const InstructionSet best = instructionSet();
  const TetMesh bar = makeBox({4, 4, 60}, Vec3::Ones());  // several pieces for each parallel loop
  const auto rows = static_cast<Index>(bar.nodes.size());
  BlockMatrix a(nodeNeighbours(rows, bar.tets));
  addRandomElements(bar.tets, 81, a);
  addRandomOuterProducts(40, 12, 1.0, 83, a);
  const Points b = randomPoints(rows, 82);
  std::vector<Points> solutions;
  for (int set = 0; set <= static_cast<int>(best); ++set)
  {
    for (const int threads : {1, 2})
    {
      forceInstructionSet(static_cast<InstructionSet>(set));
      setThreadCount(threads);
      solutions.emplace_back();
      solveWith(*GetParam().make(), a, b, placesOf(a), 1e-9, solutions.back());
    }
  }
  setThreadCount(1);
  forceInstructionSet(best);
  for (const Points& d : solutions)
  {
    EXPECT_EQ(d, solutions[0]);
  }
}

TEST(Pcg, LeadsDownWhereItIsCutShort)
{
  const BlockMatrix a = randomPositiveMatrix(150, 500, 21);
  const Points b = randomPoints(150, 22);
  const std::unique_ptr<LinearSolver> pcg = makePcg();
  pcg->setMatrix(a, placesOf(a));
  Points d;
  const int all = pcg->solve(b, 1e-6, 1000, d).iterations;
  double last = 0.0;
  for (int most = 1; most <= all; ++most)
  {
    const LinearReport report = pcg->solve(b, 1e-6, most, d);
    EXPECT_EQ(report.iterations, most);
    EXPECT_EQ(report.cut_short, most < all);
    EXPECT_FALSE(report.indefinite);
    const double energy = 0.5 * flat(d).dot(dense(a) * flat(d)) - flat(b).dot(flat(d));
    EXPECT_LT(energy, last);  // conjugate gradients go down from one iteration to the next
    last = energy;
  }
}

TEST(Pcg, NeedsNoMoreIterationsThanUnknowns)
{
  const BlockMatrix a = randomPositiveMatrix(15, 40, 91);
  const Points b = randomPoints(15, 92);
  Points d;
  EXPECT_LE(solveWith(*makePcg(), a, b, placesOf(a), 1e-6, d).iterations, 45);
}

TEST(Pcg, NeedsOneIterationForAMatrixOfDiagonalBlocks)
{
  Adjacency alone;
  alone.offsets.assign(21, 0);
  BlockMatrix a(alone);
  std::mt19937 random(93);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (Index i = 0; i < 20; ++i)
  {
    Mat3 b;
    for (double& value : b.reshaped())
    {
      value = uniform(random);
    }
    a.add(i, i, b * b.transpose() + 0.1 * Mat3::Identity());
  }
  Points d;
  EXPECT_EQ(solveWith(*makePcg(), a, randomPoints(20, 94), placesOf(a), 1e-10, d).iterations, 1);
}

}  // namespace
}  // namespace soft_tissue
