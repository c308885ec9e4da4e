#pragma once

#include <memory>

#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
enum class LinearSolverKind
{
  automatic,  ///< pcg, until it proves to take more work than cholesky
  pcg,        ///< conjugate gradients, preconditioned in two levels
  cholesky,   ///< sparse LDL^T, its symbolic part kept from step to step
};

struct LinearReport
{
  int iterations = 0;
  double residual = 0.0;    ///< |b - A d| / |b|
  bool indefinite = false;  ///< A was found not to be positive definite
  bool cut_short = false;   ///< the most iterations allowed were not enough
};

/** Solves A d = b for symmetric positive definite A of 3 x 3 blocks, of one pattern. */
class LinearSolver
{
 public:
  virtual ~LinearSolver() = default;

  /**
   * Takes the matrix of the next solves.
   * @param a  stays as it is until they are done
   * @param x  positions of the nodes, m: what moves like a rigid body; N x 3
   */
  virtual void setMatrix(const BlockMatrix& a, const Points& x) = 0;

  /**
   * @param tolerance        stop when |b - A d| <= tolerance |b|; direct solvers ignore it
   * @param most_iterations  stop after so many, > 0; what is found until then leads down, too
   * @param d                out, N x 3; of an indefinite A what was found until then, perhaps zero
   */
  virtual LinearReport solve(const Points& b, double tolerance, int most_iterations, Points& d) = 0;

  /** Forgets all that matrices before have taught it: what comes has the bits it has at first. */
  virtual void forget() = 0;

  /** Writes, or reads, what of earlier matrices the next solves depend on; the matrix itself is
   * set after that. */
  virtual void exchange(StateArchive& archive) = 0;

  /** Whether some nodes are held so much more strongly than others that forces on these are hidden
   * beside those on them: an answer is then as good as its tolerance for the strong ones only. */
  virtual bool isUneven() const = 0;
};

std::unique_ptr<LinearSolver> makePcg();
std::unique_ptr<LinearSolver> makeCholesky();

/**
 * Conjugate gradients, until a solve takes more of them than factoring the matrix would: then
 * factors, for all matrices after it but those with couplings. Work is counted, not timed.
 */
std::unique_ptr<LinearSolver> makeAutomatic();

/** That of the kind. */
std::unique_ptr<LinearSolver> makeLinearSolver(LinearSolverKind kind);

}  // namespace soft_tissue
