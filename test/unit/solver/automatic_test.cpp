#include <gtest/gtest.h>

#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/solver/linear_solver.h"
#include "support/block_matrices.h"
#include "support/finite_difference.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** A body of elastic tets, each node on a spring, N/m. */
struct Body
{
  TetMesh mesh;
  BlockMatrix matrix;

  Body(const std::array<int, 3>& cells, double poisson_ratio, double spring)
      : mesh(makeBox(cells, {0.01 * cells[0], 0.01 * cells[1], 0.01 * cells[2]})),
        matrix(nodeNeighbours(Index(mesh.nodes.size()), mesh.tets))
  {
    TetElasticity elasticity(
        mesh, MaterialModel::linear,
        std::vector<TetStiffnessParameters>(mesh.tets.size(), {1000.0, poisson_ratio}), 0);
    elasticity.addHessian(mesh.nodes, Curvature::positive, matrix);
    for (Index i = 0; i < matrix.rows(); ++i)
    {
      addDiagonal(matrix, i, spring);
    }
  }

  /** Iterations of a solve, which has to come out right. */
  int solve(LinearSolver& solver) const
  {
    const Points b = randomPoints(matrix.rows(), 5);
    Points d;
    const LinearReport report = solveWith(solver, matrix, b, mesh.nodes, 1e-6, d);
    EXPECT_FALSE(report.indefinite);
    EXPECT_LT((flat(b) - dense(matrix) * flat(d)).norm(), 1.1e-6 * flat(b).norm());
    return report.iterations;
  }
};

TEST(Automatic, GoesOverToFactorsWhereTheyAreLessWork)
{
  const Body slender({1, 1, 60}, 0.4999, 1.0);
  const std::unique_ptr<LinearSolver> solver = makeAutomatic(), pcg = makePcg();
  const int iterations = slender.solve(*pcg);
  EXPECT_GT(iterations, 100);
  EXPECT_EQ(slender.solve(*solver), iterations);
  EXPECT_EQ(slender.solve(*solver), 1);
  EXPECT_EQ(slender.solve(*solver), 1);
  solver->forget();
  EXPECT_EQ(slender.solve(*solver), iterations);
}

TEST(Automatic, StaysWithConjugateGradientsWhereTheyAreLessWork)
{
  const Body block({7, 7, 7}, 0.49, 0.01);
  const std::unique_ptr<LinearSolver> solver = makeAutomatic(), pcg = makePcg();
  const int iterations = block.solve(*pcg);
  EXPECT_GT(iterations, 100) << "so work is compared";
  EXPECT_EQ(block.solve(*solver), iterations);
  EXPECT_EQ(block.solve(*solver), iterations);
}

TEST(Automatic, DoesNotFactorMatricesWhosePatternContactChanges)
{
  Body slender({1, 1, 60}, 0.4999, 1.0);
  const std::unique_ptr<LinearSolver> solver = makeAutomatic();
  slender.solve(*solver);
  EXPECT_EQ(slender.solve(*solver), 1);
  slender.matrix.add(0, 200, 1e-3 * Mat3::Identity());
  EXPECT_GT(slender.solve(*solver), 100);
}

TEST(LinearSolver, OfAKindIsThatKind)
{
  const Body slender({1, 1, 60}, 0.4999, 1.0);
  EXPECT_EQ(slender.solve(*makeLinearSolver(LinearSolverKind::cholesky)), 1);
  for (const LinearSolverKind kind : {LinearSolverKind::pcg, LinearSolverKind::automatic})
  {
    const std::unique_ptr<LinearSolver> solver = makeLinearSolver(kind);
    EXPECT_GT(slender.solve(*solver), 100);
    EXPECT_EQ(slender.solve(*solver) == 1, kind == LinearSolverKind::automatic);
  }
}

}  // namespace
}  // namespace soft_tissue
