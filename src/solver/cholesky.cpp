#include <Eigen/SparseCholesky>
#include <algorithm>

#include "soft_tissue_sim/solver/linear_solver.h"

namespace soft_tissue
{
namespace
{
class Cholesky : public LinearSolver
{
 public:
  void setMatrix(const BlockMatrix& a, const Points& x) override
  {
    if (!hasPatternOf(a))
    {
      analyse(a);
    }
    fill(a);
    factor_.factorize(matrix_);
    iterative_->setMatrix(a, x);
  }

  LinearReport solve(const Points& b, double tolerance, int most_iterations, Points& d) override
  {
    if (factor_.info() != Eigen::Success)  // singular
    {
      return iterative_->solve(b, tolerance, most_iterations, d);
    }
    if (!(factor_.vectorD().allFinite() && factor_.vectorD().minCoeff() > 0.0))
    {
      d.assign(b.size(), Vec3::Zero());
      return {1, 1.0, true, false};
    }
    const auto size = static_cast<Eigen::Index>(3 * b.size());
    const Eigen::Map<const Eigen::VectorXd> right(b.data()->data(), size);
    d.resize(b.size());
    Eigen::Map<Eigen::VectorXd>(d.data()->data(), size) = factor_.solve(right);
    return {1, 0.0, false, false};
  }

  bool isUneven() const override { return iterative_->isUneven(); }

 private:
  bool hasPatternOf(const BlockMatrix& a) const
  {
    const auto samePlace = [](const Coupling& c, const Edge& place) {
      return c.row == place[0] && c.column == place[1];
    };
    return offsets_ == a.offsets() && columns_ == a.columns() &&
           std::equal(a.couplings().begin(), a.couplings().end(), coupled_.begin(), coupled_.end(),
                      samePlace);
  }

  /** Calls visit(j, i, block) for all blocks (j, i), j <= i, always in the same order. */
  template <typename Visit>
  static void forEachBlock(const BlockMatrix& a, const Visit& visit)
  {
    for (Index j = 0; j < a.rows(); ++j)
    {
      for (Index k = a.diagonal(j); k < a.offsets()[j + 1]; ++k)
      {
        visit(j, a.columns()[k], a.block(k));
      }
    }
    for (const Coupling& c : a.couplings())
    {
      visit(c.row, c.column, c.block.data());
    }
  }

  /** Pattern of the lower triangle: column 3j + k holds rows 3i + l >= 3j + k of blocks i >= j. */
  void analyse(const BlockMatrix& a)
  {
    offsets_ = a.offsets();
    columns_ = a.columns();
    coupled_.clear();
    for (const Coupling& c : a.couplings())
    {
      coupled_.push_back({c.row, c.column});
    }
    std::vector<Eigen::Triplet<double>> entries;
    forEachBlock(a, [&](Index j, Index i, const double*) {
      for (int column = 0; column < 3; ++column)
      {
        for (int row = i == j ? column : 0; row < 3; ++row)
        {
          entries.emplace_back(3 * i + row, 3 * j + column, 0.0);
        }
      }
    });
    matrix_.resize(3 * a.rows(), 3 * a.rows());
    matrix_.setFromTriplets(entries.begin(), entries.end());
    factor_.analyzePattern(matrix_);
    places_.clear();
    forEachBlock(a, [&](Index j, Index i, const double*) {
      for (int column = 0; column < 3; ++column)
      {
        const int* begin = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * j + column];
        const int* end = matrix_.innerIndexPtr() + matrix_.outerIndexPtr()[3 * j + column + 1];
        const int* first = std::lower_bound(begin, end, 3 * i + (i == j ? column : 0));
        places_.push_back(static_cast<Index>(first - matrix_.innerIndexPtr()));
      }
    });
  }

  void fill(const BlockMatrix& a)
  {
    const Index* place = places_.data();
    forEachBlock(a, [&](Index j, Index i, const double* block) {
      for (int column = 0; column < 3; ++column)
      {
        // Block (i, j) below the diagonal is the transpose of the stored block (j, i).
        double* value = matrix_.valuePtr() + *place++;
        for (int row = i == j ? column : 0; row < 3; ++row)
        {
          *value++ = block[3 * row + column];
        }
      }
    });
  }

  std::vector<Index> offsets_, columns_;  ///< the pattern analysed
  std::vector<Edge> coupled_;             ///< and its couplings
  std::vector<Index> places_;  ///< per block and column: where its numbers begin in matrix_
  Eigen::SparseMatrix<double> matrix_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
  std::unique_ptr<LinearSolver> iterative_ = makePcg();
};
}  // namespace

std::unique_ptr<LinearSolver> makeCholesky()
{
  return std::make_unique<Cholesky>();
}

}  // namespace soft_tissue
