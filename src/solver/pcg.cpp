#include <Eigen/LU>
#include <cmath>

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
    direction_.resize(n);
    image_.resize(n);
    d.assign(n, Vec3::Zero());
    Sums now = parallelSum(n, kGrain, [&](Index begin, Index end) {
      Sums sums;
      for (Index i = begin; i < end; ++i)
      {
        direction_[i] = inverse_diagonal_[i] * residual_[i];
        sums.add(residual_[i], direction_[i]);
      }
      return sums;
    });
    const double enough = tolerance * tolerance * now.rr;
    const BlockRows rows = {a.offsets().data(), a.columns().data(), a.values().data()};
    const int most = 10 * static_cast<int>(n) + 100;
    if (!std::isfinite(now.rr))
    {
      return {0, true};
    }
    int iteration = 0;
    while (now.rr > enough && iteration < most)
    {
      ++iteration;
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
      const double step = now.rz / curvature;
      const Sums next = parallelSum(n, kGrain, [&](Index begin, Index end) {
        Sums sums;
        for (Index i = begin; i < end; ++i)
        {
          d[i] += step * direction_[i];
          residual_[i] -= step * image_[i];
          image_[i] = inverse_diagonal_[i] * residual_[i];
          sums.add(residual_[i], image_[i]);
        }
        return sums;
      });
      if (!std::isfinite(next.rr))  // singular, and no solution
      {
        d.assign(n, Vec3::Zero());
        return {iteration, true};
      }
      const double ratio = next.rz / now.rz;
      now = next;
      parallelFor(n, kGrain, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i)
        {
          direction_[i] = image_[i] + ratio * direction_[i];
        }
      });
    }
    return {iteration, false};
  }

 private:
  /** |r|^2 and r . z, z being the preconditioned residual. */
  struct Sums
  {
    double rr = 0.0;
    double rz = 0.0;

    void add(const Vec3& r, const Vec3& z)
    {
      rr += r.squaredNorm();
      rz += r.dot(z);
    }
    void operator+=(const Sums& other)
    {
      rr += other.rr;
      rz += other.rz;
    }
  };

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
  Points residual_, direction_, image_;
};
}  // namespace

std::unique_ptr<LinearSolver> makePcg()
{
  return std::make_unique<Pcg>();
}

}  // namespace soft_tissue
