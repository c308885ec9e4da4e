#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "coupling_rows.h"
#include "outer_rows.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/solver/linear_solver.h"
#include "soft_tissue_sim/solver/pcg_kernels.h"
#include "soft_tissue_sim/solver/rigid_groups.h"

namespace soft_tissue
{
namespace
{
// Per parallel piece, some microseconds each:
constexpr Index kGrain = 256;        // rows of a matrix
constexpr Index kVectorGrain = 512;  // nodes of a vector
constexpr Index kGroupGrain = 10;    // groups of nodes
constexpr Index kCoarseGrain = 48;   // rows of the groups' matrix
/** Answers no more exact than this are found in single precision, unless some nodes are so stiff
 * that rounded positions of theirs make forces that the soft ones' drown in. */
constexpr double kSingleTolerance = 1e-3;

/** Conjugate gradients in one precision, preconditioned by the inverse diagonal blocks plus the
 * rigid motions of groups of nodes. */
template <typename Real>
class Conjugator
{
 public:
  LinearReport solve(const BlockMatrix& a, const Points& b, double tolerance, int most, Points& d)
  {
    const Index n = a.rows();
    if (!loaded_)
    {
      load(a);
    }
    d.assign(n, Vec3::Zero());
    double scale = 0.0;  // |b| becomes about 1: what is squared below stays within range
    for (const Vec3& v : b)
    {
      scale += v.squaredNorm();
    }
    scale = std::sqrt(scale);
    if (!(scale > 0.0) || !std::isfinite(scale))
    {
      return {0, 0.0, scale != 0.0, false};
    }
    takeRightSide(b, 1.0 / scale);
    const LinearReport report = iterate(a, n, tolerance, most);
    for (Index i = 0; i < n; ++i)
    {
      const Vec3 moved(solution_[3 * i], solution_[3 * i + 1], solution_[3 * i + 2]);
      d[i] = scale * moved;
    }
    return report;
  }

  /** The matrix is another now. */
  void forgetMatrix() { loaded_ = false; }

  /** Takes the coarse level of the next solves. */
  void setGroups(const RigidGroups& groups)
  {
    arms_.assign(groups.arms().begin(), groups.arms().end());
    coarse_inverse_.assign(groups.inverse().begin(), groups.inverse().end());
    coarse_residual_.assign(6 * static_cast<std::size_t>(groups.size()), Real(0));
    coarse_move_.assign(coarse_residual_.size() + 6, Real(0));
    groups_ = {groups.size(), groups.offsets().data(), groups.nodes().data(), groups.group().data(),
               arms_.data()};
  }

 private:
  void load(const BlockMatrix& a)
  {
    const Index n = a.rows();
    loaded_ = true;
    couplings_.load(a.couplings());
    outer_.load(a.outer(), n);
    values_.resize(a.values().size());
    inverse_.resize(9 * static_cast<std::size_t>(n) + 1);
    parallelFor(n, kGrain, [&](Index begin, Index end) {
      for (Index row = begin; row < end; ++row)
      {
        loadRow(a, row);
        Mat3 diagonal = Eigen::Map<const Mat3>(a.block(a.diagonal(row)));
        outer_.addDiagonal(row, diagonal.data());
        const Mat3 inverse = diagonal.inverse();
        const bool usable = inverse.allFinite();
        for (int k = 0; k < 9; ++k)
        {
          inverse_[9 * row + k] = static_cast<Real>(usable ? inverse.data()[k] : k % 4 == 0);
        }
      }
    });
  }

  void takeRightSide(const Points& b, double scale)
  {
    residual_.resize(3 * b.size());
    direction_.resize(residual_.size());
    image_.resize(residual_.size());
    solution_.assign(residual_.size(), Real(0));
    for (std::size_t i = 0; i < b.size(); ++i)
    {
      for (int k = 0; k < 3; ++k)
      {
        residual_[3 * i + k] = static_cast<Real>(scale * b[i][k]);
      }
    }
  }

  void loadRow(const BlockMatrix& a, Index row)
  {
    for (Index k = a.offsets()[row]; k < a.offsets()[row + 1]; ++k)
    {
      Real* to = values_.data() + 9 * static_cast<std::size_t>(k);
      const bool upper = k >= a.diagonal(row);
      const double* from = a.block(upper ? k : a.mirror(k));
      for (int i = 0; i < 9; ++i)
      {
        to[i] = static_cast<Real>(from[upper ? i : 3 * (i % 3) + i / 3]);
      }
    }
  }

  LinearReport iterate(const BlockMatrix& a, Index n, double tolerance, int most)
  {
    const PcgKernels<Real>& kernels = pcgKernels<Real>(instructionSet());
    const BlockRows<Real> rows = {a.offsets().data(), a.columns().data(), values_.data()};
    Real* d = solution_.data();
    Real* r = residual_.data();
    Real* p = direction_.data();
    Real* q = image_.data();
    const Real* inverse = inverse_.data();
    PcgSums now = parallelSum(n, kVectorGrain, [&](Index begin, Index end) {
      return kernels.precondition(begin, end, inverse, r, p);
    });
    now.rz += solveCoarse(kernels);
    const Real* move = coarse_move_.data();
    if (groups_.size > 0)
    {
      parallelFor(n, kVectorGrain,
                  [&](Index begin, Index end) { kernels.spread(groups_, begin, end, move, p); });
    }
    const double all = now.rr, enough = tolerance * tolerance * all;
    const int hopeless = 10 * static_cast<int>(n) + 100;
    int iteration = 0;
    while (now.rr > enough && iteration < std::min(most, hopeless))
    {
      ++iteration;
      double curvature = parallelSum(n, kGrain, [&](Index begin, Index end) {
        return kernels.multiply(rows, begin, end, p, q);
      });
      curvature += couplings_.addProduct(kernels, p, q);
      if (!outer_.empty())
      {
        curvature += outer_.addProduct(p, q);
      }
      if (!(curvature > 0.0))
      {
        return {iteration, 1.0, true, false};
      }
      const Real step = static_cast<Real>(now.rz / curvature);
      PcgSums next = parallelSum(n, kVectorGrain, [&](Index begin, Index end) {
        return kernels.advance(begin, end, inverse, step, p, d, r, q);
      });
      if (!std::isfinite(next.rr))  // singular, and no solution
      {
        solution_.assign(solution_.size(), Real(0));
        return {iteration, 1.0, true, false};
      }
      next.rz += solveCoarse(kernels);
      const Real ratio = static_cast<Real>(next.rz / now.rz);
      now = next;
      parallelFor(n, kVectorGrain, [&](Index begin, Index end) {
        if (groups_.size > 0)
        {
          kernels.spread(groups_, begin, end, move, q);
        }
        kernels.turn(begin, end, ratio, q, p);
      });
    }
    return {iteration, std::sqrt(now.rr / all), !std::isfinite(now.rr),
            now.rr > enough && iteration == most};
  }

  /** Groups' moves for the residual; its product with them. */
  double solveCoarse(const PcgKernels<Real>& kernels)
  {
    if (groups_.size == 0)
    {
      return 0.0;
    }
    parallelFor(groups_.size, kGroupGrain, [&](Index begin, Index end) {
      kernels.gather(groups_, begin, end, residual_.data(), coarse_residual_.data());
    });
    const Index size = 6 * groups_.size;
    parallelFor(size, kCoarseGrain, [&](Index begin, Index end) {
      kernels.multiplyDense(size, begin, end, coarse_inverse_.data(), coarse_residual_.data(),
                            coarse_move_.data());
    });
    double product = 0.0;
    for (std::size_t i = 0; i < coarse_residual_.size(); ++i)
    {
      product += static_cast<double>(coarse_residual_[i]) * coarse_move_[i];
    }
    return product;
  }

  bool loaded_ = false;
  std::vector<Real> values_;  ///< the matrix, both triangles
  CouplingRows<Real> couplings_;
  OuterRows<Real> outer_;
  std::vector<Real> inverse_;  ///< of its diagonal blocks
  std::vector<Real> residual_, direction_, image_, solution_;
  NodeGroups<Real> groups_ = {};
  std::vector<Real> arms_, coarse_inverse_, coarse_residual_, coarse_move_;
};

class Pcg : public LinearSolver
{
 public:
  void setMatrix(const BlockMatrix& a, const Points& x) override
  {
    matrix_ = &a;
    single_.forgetMatrix();
    double_.forgetMatrix();
    if (groups_.outdated(a, x))
    {
      groups_.build(a, x);
      single_.setGroups(groups_);
      double_.setGroups(groups_);
    }
  }

  LinearReport solve(const Points& b, double tolerance, int most_iterations, Points& d) override
  {
    return tolerance >= kSingleTolerance && !groups_.isUneven()
               ? single_.solve(*matrix_, b, tolerance, most_iterations, d)
               : double_.solve(*matrix_, b, tolerance, most_iterations, d);
  }

  void forget() override { groups_ = RigidGroups(); }

  void exchange(StateArchive& archive) override
  {
    groups_.exchange(archive);
    if (archive.reading())
    {
      single_.setGroups(groups_);
      double_.setGroups(groups_);
    }
  }

  bool isUneven() const override { return groups_.isUneven(); }

 private:
  const BlockMatrix* matrix_ = nullptr;
  RigidGroups groups_;
  Conjugator<float> single_;
  Conjugator<double> double_;
};
}  // namespace

std::unique_ptr<LinearSolver> makePcg()
{
  return std::make_unique<Pcg>();
}

}  // namespace soft_tissue
