#include <optional>

#include "cholesky.h"

namespace soft_tissue
{
namespace
{
/** Iterations a solve may always take: few enough that factors are not worth a thought. */
constexpr int kMany = 100;
/** Rows from which on even the analysis of a matrix would be felt. */
constexpr Index kMostRows = 20000;
/** How long a multiplication of a factorisation takes, in those of conjugate gradients. */
constexpr double kFactorsCost = 2.0;

class Automatic : public LinearSolver
{
 public:
  void setMatrix(const BlockMatrix& a, const Points& x) override
  {
    matrix_ = &a;
    factors_ = restored_.value_or(direct_ && a.couplings().empty());
    restored_.reset();
    (factors_ ? static_cast<LinearSolver&>(cholesky_) : *pcg_).setMatrix(a, x);
  }

  LinearReport solve(const Points& b, double tolerance, int most_iterations, Points& d) override
  {
    if (factors_)
    {
      return cholesky_.solve(b, tolerance, most_iterations, d);
    }
    const LinearReport report = pcg_->solve(b, tolerance, most_iterations, d);
    direct_ = direct_ || (report.iterations > kMany && outweighsFactors(report.iterations));
    return report;
  }

  void forget() override
  {
    direct_ = false;
    pcg_->forget();
    cholesky_.forget();
  }

  void exchange(StateArchive& archive) override
  {
    bool factors = factors_;
    archive.value(direct_);
    archive.value(factors);
    pcg_->exchange(archive);
    cholesky_.exchange(archive);
    if (archive.reading())
    {
      restored_ = factors;
    }
  }

  bool isUneven() const override { return factors_ ? cholesky_.isUneven() : pcg_->isUneven(); }

 private:
  bool outweighsFactors(int iterations)
  {
    if (matrix_->rows() > kMostRows || !matrix_->couplings().empty())
    {
      return false;
    }
    const double iteration = 9.0 * static_cast<double>(matrix_->columns().size()) +
                             6.0 * static_cast<double>(matrix_->outer().nodes().size());
    return iteration * iterations > kFactorsCost * cholesky_.workOf(*matrix_);
  }

  const BlockMatrix* matrix_ = nullptr;
  bool direct_ = false;           ///< from the next matrix on
  bool factors_ = false;          ///< this one
  std::optional<bool> restored_;  ///< whether the next one has factors, as it had when it was saved
  Cholesky cholesky_;
  std::unique_ptr<LinearSolver> pcg_ = makePcg();
};
}  // namespace

std::unique_ptr<LinearSolver> makeAutomatic()
{
  return std::make_unique<Automatic>();
}

std::unique_ptr<LinearSolver> makeLinearSolver(LinearSolverKind kind)
{
  switch (kind)
  {
    case LinearSolverKind::pcg:
      return makePcg();
    case LinearSolverKind::cholesky:
      return makeCholesky();
    default:
      return makeAutomatic();
  }
}

}  // namespace soft_tissue
