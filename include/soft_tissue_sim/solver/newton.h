#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "soft_tissue_sim/base/timer.h"
#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/solver/linear_solver.h"

namespace soft_tissue
{
struct NewtonOptions
{
  /**
   * Stop when |sum of forces| <= tolerance * sum of the norms of the terms' forces, free nodes
   * only; or when the forces left would move no node by more than positions can tell apart, or
   * than `settled`.
   */
  double tolerance = 1e-3;
  /**
   * Nor go on when a full step has left forces that, in proportion, would move no node by more than
   * this length, m: it ends what tiny forces alone would keep going.
   */
  double settled = 0.0;
  int max_iterations = 20;
  /**
   * Wall time, s, after which no iteration ends if the ones before tell how long one takes. The
   * first is done in any case, with as many linear iterations as fit in.
   */
  double budget_s = std::numeric_limits<double>::infinity();
};

struct NewtonReport
{
  int iterations = 0;
  int linear_iterations = 0;
  int evaluations = 0;    ///< of energy and forces, or second derivatives, of all terms
  double residual = 0.0;  ///< relative, as in NewtonOptions::tolerance
  bool converged = false;
  bool out_of_time = false;  ///< stopped for NewtonOptions::budget_s
  bool finite = true;        ///< false: forces or energy were no numbers at the start
  double value = 0.0;        ///< the potential at the end, J
  /** Estimate of how far nodes still are from the minimiser, m, by how far the last solve said they
   * go for a force; NaN before the first one. */
  double position_error_m = std::nan("");
  double linear_s = 0.0;  ///< wall time in linear solves
};

/**
 * Minimises a sum of energy terms over the free nodes by Newton's method with line search.
 *
 * Exact second derivatives first: they converge quadratically. Where they turn out indefinite, that
 * iteration and the next few take their positive part instead, which always leads down. Second
 * derivatives serve on, from one minimisation of the same terms to the next as well, as long as
 * they lead where they should.
 */
class NewtonSolver
{
 public:
  /**
   * @param neighbours  coupled nodes, all bodies
   * @param fixed       nodes that keep their position
   */
  NewtonSolver(const Adjacency& neighbours, const std::vector<Index>& fixed,
               std::unique_ptr<LinearSolver> linear);

  /**
   * Moves x down the potential until the forces balance.
   * @param terms      what is minimised
   * @param x          in: start, out: minimiser; never non-finite
   * @param seconds    per term: wall time spent in it is added
   * @param other      another start, taken where the potential is lower there; lost
   */
  NewtonReport minimise(const std::vector<EnergyTerm*>& terms, const NewtonOptions& options,
                        Points& x, std::vector<double>& seconds, Points* other = nullptr);

  /** Makes the next minimisation begin with second derivatives of its own. */
  void forgetMatrix() { matrix_serves_ = matrix_leads_ = false; }

  bool isFixed(Index node) const { return is_fixed_[node]; }

  /** Makes minimisations from here on independent of those before. */
  void forget()
  {
    forgetMatrix();
    linear_->forget();
    trust_ = trusted_ = 0;
  }

  /**
   * Writes, or reads, what the next minimisation takes over: second derivatives that serve on.
   * @param terms  all that were or may be minimised, in an order that stays
   */
  void exchange(StateArchive& archive, const std::vector<EnergyTerm*>& terms);

  /** Copies the positions of fixed nodes from one state to another. */
  void restoreFixed(const Points& from, Points& to) const;

 private:
  /** What the terms say at some positions. */
  struct State
  {
    double value = 0.0;
    double magnitude = 0.0;  ///< sum of the terms' absolute values: the scale of rounding errors
    double force = 0.0;      ///< norm of the sum of the terms' forces on free nodes, N
    double residual = 0.0;   ///< as in NewtonOptions::tolerance
  };
  State evaluate(const std::vector<EnergyTerm*>& terms, const Points& x, Points& gradient,
                 std::vector<double>& seconds);
  double moveInto(Points& sum, Points& part) const;
  void assemble(const std::vector<EnergyTerm*>& terms, const Points& x, Curvature curvature,
                NewtonReport& report, std::vector<double>& seconds);
  void takeDescent();
  LinearReport solve(double accuracy, NewtonReport& report);
  bool endsWithin(double within, NewtonReport& report);
  int affordableLinearIterations() const;
  LinearReport solveAnew(const std::vector<EnergyTerm*>& terms, const Points& x, double residual,
                         double accuracy, NewtonReport& report, std::vector<double>& seconds);
  State tryStep(const std::vector<EnergyTerm*>& terms, const Points& x, double step,
                std::vector<double>& seconds);
  double searchLine(const std::vector<EnergyTerm*>& terms, const Points& x, State& state,
                    std::vector<double>& seconds);

  std::vector<Index> fixed_;
  std::vector<bool> is_fixed_;       ///< per node
  std::vector<Index> fixed_blocks_;  ///< blocks in a row or column of a fixed node
  BlockMatrix hessian_;
  std::unique_ptr<LinearSolver> linear_;
  bool matrix_serves_ = false;  ///< hessian_ is still good enough for a direction
  bool matrix_leads_ = false;   ///< not quite, but it brought the last iteration forward
  std::vector<EnergyTerm*> matrix_terms_;
  Points matrix_at_;  ///< where nodes were when hessian_ was made
  int trust_ = 0;     ///< ends in a row that are taken for near without a look, since the last one
  int trusted_ = 0;   ///< those that are left of them
  double indefinite_at_ = 0.0;  ///< the residual where exact curvature last failed
  /** Farthest move of a node over the norm of the forces, of the last solve, m/N. */
  double reach_ = std::nan("");

  // What things took when last done, s, and the time they have to fit in.
  Timer timer_;
  int evaluations_ = 0;
  double budget_s_ = 0.0;
  double evaluation_s_ = 0.0, assembly_s_ = 0.0, linear_iteration_s_ = 0.0;
  double directing_s_ = 0.0;  ///< direction and step, without second derivatives
  Points gradient_, trial_gradient_, descent_, direction_, trial_;
  Points term_gradient_;  ///< zero outside evaluate()
};

}  // namespace soft_tissue
