#pragma once

#include <Eigen/SparseCholesky>

#include "soft_tissue_sim/solver/linear_solver.h"

namespace soft_tissue
{
/**
 * Outer products G^T D G beside the blocks A would fill the matrix. With unknowns s = |D|^(1/2) G d
 * of their own they don't: what is factored is
 *
 *   [ A  B^T ]        B = |D|^(1/2) G,
 *   [ B  -S  ],       S = sign D,
 *
 * whose first rows come to A + G^T D G. That matrix is positive definite exactly where the pivots
 * have the signs of -S, and no others below zero. Unknowns are eliminated node by node; that of an
 * outer product right after a node that all of its nodes are neighbours of, so it couples no more.
 */
class Cholesky : public LinearSolver
{
 public:
  void setMatrix(const BlockMatrix& a, const Points& x) override;
  LinearReport solve(const Points& b, double tolerance, int most_iterations, Points& d) override;
  void forget() override { iterative_->forget(); }
  // Which order the unknowns are taken in depends on the matrix alone.
  void exchange(StateArchive& archive) override { iterative_->exchange(archive); }
  bool isUneven() const override { return iterative_->isUneven(); }

  /** Multiplications that factoring a matrix of this pattern takes. */
  double workOf(const BlockMatrix& a);

 private:
  using Ordering = Eigen::NaturalOrdering<int>;
  /** Knows how much its columns will hold. */
  struct Factor : Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Ordering>
  {
    double work() const { return m_nonZerosPerCol.cast<double>().squaredNorm(); }
  };

  bool hasPatternOf(const BlockMatrix& a) const;
  void analyse(const BlockMatrix& a);
  void orderUnknowns(const BlockMatrix& a);
  Index placeOf(int row, int column) const;
  template <typename Visit>
  void forEachNumber(const BlockMatrix& a, const Visit& visit) const;

  std::vector<Index> offsets_, columns_;            ///< the pattern analysed
  std::vector<Edge> coupled_;                       ///< and its couplings
  std::vector<Index> outer_offsets_, outer_nodes_;  ///< and its outer products
  std::vector<Index> first_of_node_;                ///< of its three unknowns
  std::vector<Index> of_outer_;                     ///< unknown of each outer product
  std::vector<Index> places_;                       ///< in matrix_, see forEachNumber()
  Eigen::SparseMatrix<double> matrix_;              ///< its lower triangle
  Eigen::Index expected_negative_ = 0;              ///< pivots
  Eigen::VectorXd right_, solution_;
  Factor factor_;
  std::unique_ptr<LinearSolver> iterative_ = makePcg();
};

}  // namespace soft_tissue
