#include <Eigen/LU>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/solver/block_product.h"
#include "soft_tissue_sim/solver/linear_solver.h"

namespace soft_tissue
{
namespace
{
constexpr Index kGrain = 256;

class Pcg : public LinearSolver
{
 public:
  Pcg() : product_(blockProduct(instructionSet())) {}

  LinearReport solve(const BlockMatrix& a, const Points& b, double tolerance, Points& d) override
  {
    const Index n = a.rows();
    invertDiagonal(a);
    residual_ = b;
    preconditioned_.resize(n);
    direction_.resize(n);
    image_.resize(n);
    d.assign(n, Vec3::Zero());
    const double enough = tolerance * tolerance * squaredNorm(b);
    double rz = parallelSum(n, kGrain, [&](Index begin, Index end) {
      double sum = 0.0;
      for (Index i = begin; i < end; ++i)
      {
        direction_[i] = inverse_diagonal_[i] * residual_[i];
        sum += residual_[i].dot(direction_[i]);
      }
      return sum;
    });
    if (rz == 0.0)
    {
      return {};
    }
    const BlockRows rows = {a.offsets().data(), a.columns().data(), a.values().data()};
    const int most = 10 * static_cast<int>(n) + 100;
    for (int iteration = 1; iteration <= most; ++iteration)
    {
      const double curvature = parallelSum(n, kGrain, [&](Index begin, Index end) {
        product_(rows, begin, end, direction_.data()->data(), image_.data()->data());
        double sum = 0.0;
        for (Index i = begin; i < end; ++i)
        {
          sum += direction_[i].dot(image_[i]);
        }
        return sum;
      });
      if (!(curvature > 0.0))
      {
        return {iteration, true};
      }
      const double step = rz / curvature;
      const double squared = parallelSum(n, kGrain, [&](Index begin, Index end) {
        double sum = 0.0;
        for (Index i = begin; i < end; ++i)
        {
          d[i] += step * direction_[i];
          residual_[i] -= step * image_[i];
          sum += residual_[i].squaredNorm();
        }
        return sum;
      });
      if (squared <= enough)
      {
        return {iteration, false};
      }
      const double rz_next = parallelSum(n, kGrain, [&](Index begin, Index end) {
        double sum = 0.0;
        for (Index i = begin; i < end; ++i)
        {
          preconditioned_[i] = inverse_diagonal_[i] * residual_[i];
          sum += residual_[i].dot(preconditioned_[i]);
        }
        return sum;
      });
      const double ratio = rz_next / rz;
      rz = rz_next;
      parallelFor(n, kGrain, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i)
        {
          direction_[i] = preconditioned_[i] + ratio * direction_[i];
        }
      });
    }
    return {most, false};
  }

 private:
  static double squaredNorm(const Points& v)
  {
    return parallelSum(static_cast<Index>(v.size()), kGrain, [&](Index begin, Index end) {
      double sum = 0.0;
      for (Index i = begin; i < end; ++i)
      {
        sum += v[i].squaredNorm();
      }
      return sum;
    });
  }

  void invertDiagonal(const BlockMatrix& a)
  {
    inverse_diagonal_.resize(a.rows());
    for (Index i = 0; i < a.rows(); ++i)
    {
      const Mat3 block = Eigen::Map<const Mat3>(a.block(a.diagonal(i)));
      inverse_diagonal_[i] = block.inverse();
      if (!inverse_diagonal_[i].allFinite())
      {
        inverse_diagonal_[i].setIdentity();
      }
    }
  }

  BlockProduct product_;
  std::vector<Mat3> inverse_diagonal_;
  Points residual_, preconditioned_, direction_, image_;
};
}  // namespace

std::unique_ptr<LinearSolver> makePcg()
{
  return std::make_unique<Pcg>();
}

}  // namespace soft_tissue
