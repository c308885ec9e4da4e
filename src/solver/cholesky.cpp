#include <Eigen/SparseCholesky>

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
    if (offsets_ != a.offsets() || columns_ != a.columns())
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

 private:
  /** Pattern of the lower triangle: column 3j + k holds rows 3i + l >= 3j + k of blocks i >= j. */
  void analyse(const BlockMatrix& a)
  {
    const Index rows = a.rows();
    offsets_ = a.offsets();
    columns_ = a.columns();
    std::vector<Eigen::Triplet<double>> entries;
    for (Index j = 0; j < rows; ++j)
    {
      for (Index k = a.diagonal(j); k < a.offsets()[j + 1]; ++k)
      {
        const Index i = a.columns()[k];
        for (int column = 0; column < 3; ++column)
        {
          for (int row = i == j ? column : 0; row < 3; ++row)
          {
            entries.emplace_back(3 * i + row, 3 * j + column, 0.0);
          }
        }
      }
    }
    matrix_.resize(3 * rows, 3 * rows);
    matrix_.setFromTriplets(entries.begin(), entries.end());
    factor_.analyzePattern(matrix_);
  }

  void fill(const BlockMatrix& a)
  {
    double* value = matrix_.valuePtr();
    for (Index j = 0; j < a.rows(); ++j)
    {
      for (int column = 0; column < 3; ++column)
      {
        for (Index k = a.diagonal(j); k < a.offsets()[j + 1]; ++k)
        {
          // Block (i, j) below the diagonal is the transpose of the stored block (j, i).
          const double* block = a.block(k);
          for (int row = k == a.diagonal(j) ? column : 0; row < 3; ++row)
          {
            *value++ = block[3 * row + column];
          }
        }
      }
    }
  }

  std::vector<Index> offsets_, columns_;  ///< the pattern analysed
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
