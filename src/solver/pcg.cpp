#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "coupling_rows.h"
#include "node_vectors.h"
#include "outer_rows.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/solver/linear_solver.h"
#include "soft_tissue_sim/solver/packed_rows.h"
#include "soft_tissue_sim/solver/rigid_groups.h"

namespace soft_tissue
{
namespace
{
constexpr Index kPiece = 40;         // nodes of a parallel piece at most
constexpr Index kCoarseGrain = 120;  // rows of the groups' matrix, per parallel piece
/** Answers no more exact than this are found in single precision, unless some nodes are so stiff
 * that rounded positions of theirs make forces that the soft ones' drown in. */
constexpr double kSingleTolerance = 1e-3;

/** Conjugate gradients in one precision, preconditioned by the inverse diagonal blocks plus the
 * rigid motions of groups of nodes. All of it has nodes in the groups' order, and pieces of groups
 * for pieces of all loops: threads then read little of what others write. */
template <typename Real>
class Conjugator
{
 public:
  LinearReport solve(const BlockMatrix& a, const RigidGroups& groups, const Points& b,
                     double tolerance, int most, Points& d)
  {
    const Index n = a.rows();
    d.resize(n);
    if (!has_groups_)
    {
      takeGroups(groups);
    }
    if (!loaded_)
    {
      load(a);
    }
    // |b| becomes about 1: what is squared below stays within range.
    const double scale = std::sqrt(dot(b, b));
    if (!(scale > 0.0) || !std::isfinite(scale))
    {
      d.assign(n, Vec3::Zero());
      return {0, 0.0, scale != 0.0, false};
    }
    takeRightSide(b, 1.0 / scale);
    const LinearReport report = iterate(n, tolerance, most);
    forPlaces([&](Index i) {
      const Vec3 moved(solution_[3 * i], solution_[3 * i + 1], solution_[3 * i + 2]);
      d[nodes_[i]] = scale * moved;
    });
    return report;
  }

  /** The matrix is another now. */
  void forgetMatrix() { loaded_ = false; }

  /** The groups are others now. */
  void forgetGroups() { has_groups_ = false; }

 private:
  void takeGroups(const RigidGroups& groups)
  {
    has_groups_ = true;
    if (nodes_ != groups.nodes())
    {
      offsets_.clear();
    }
    nodes_ = groups.nodes();
    place_.resize(nodes_.size());
    group_.resize(nodes_.size());
    arms_.resize(3 * nodes_.size() + 1);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
    {
      place_[nodes_[i]] = static_cast<Index>(i);
      group_[i] = groups.group()[nodes_[i]];
      for (int k = 0; k < 3; ++k)
      {
        arms_[3 * i + k] = static_cast<Real>(groups.arms()[3 * nodes_[i] + k]);
      }
    }
    coarse_inverse_.assign(groups.inverse().begin(), groups.inverse().end());
    coarse_residual_.assign(6 * static_cast<std::size_t>(groups.size()), Real(0));
    coarse_move_.assign(coarse_residual_.size() + 7, Real(0));
    pieces_ = {0};
    group_pieces_ = {0};
    for (int g = 0; g < groups.size(); ++g)
    {
      cutUpTo(groups.offsets()[g + 1]);
      group_pieces_.push_back(pieceCount());
    }
    cutUpTo(static_cast<Index>(nodes_.size()));
    gathered_.assign(6 * static_cast<std::size_t>(pieceCount()), Real(0));
    groups_ = {pieces_.data(), group_.data(), arms_.data()};
  }

  /** Cuts what there is of nodes up to `end` in equal pieces. */
  void cutUpTo(Index end)
  {
    const Index begin = pieces_.back();
    const std::int64_t size = end - begin, count = (size + kPiece - 1) / kPiece;
    for (std::int64_t k = 1; k <= count; ++k)
    {
      pieces_.push_back(begin + static_cast<Index>(size * k / count));
    }
  }

  void load(const BlockMatrix& a)
  {
    const PcgKernels<Real>& kernels = pcgKernels<Real>(instructionSet());
    loaded_ = true;
    couplings_.load(kernels, a.couplings(), place_);
    outer_.load(a.outer(), place_);
    if (offsets_ != a.offsets() || columns_ != a.columns())
    {
      offsets_ = a.offsets();
      columns_ = a.columns();
      rows_.takePattern(a, nodes_, place_);
    }
    inverse_.resize(9 * static_cast<std::size_t>(a.rows()) + 1);
    parallelFor(pieceCount(), 1, [&](Index begin, Index end) {
      rows_.load(kernels, a.values().data(), pieces_[begin], pieces_[end]);
      for (Index i = pieces_[begin]; i < pieces_[end]; ++i)
      {
        Mat3 diagonal = Eigen::Map<const Mat3>(a.block(a.diagonal(nodes_[i])));
        outer_.addDiagonal(i, diagonal.data());
        const Mat3 inverse = diagonal.inverse();
        const bool usable = inverse.allFinite();
        for (int k = 0; k < 9; ++k)
        {
          inverse_[9 * i + k] = static_cast<Real>(usable ? inverse.data()[k] : k % 4 == 0);
        }
      }
    });
  }

  void takeRightSide(const Points& b, double scale)
  {
    residual_.resize(3 * b.size() + 1);
    direction_.resize(residual_.size());
    image_.resize(residual_.size());
    solution_.resize(residual_.size());
    forPlaces([&](Index i) {
      for (int k = 0; k < 3; ++k)
      {
        residual_[3 * i + k] = static_cast<Real>(scale * b[nodes_[i]][k]);
        solution_[3 * i + k] = Real(0);
      }
    });
  }

  LinearReport iterate(Index n, double tolerance, int most)
  {
    const PcgKernels<Real>& kernels = pcgKernels<Real>(instructionSet());
    const BlockRows<Real> rows = rows_.view();
    Real* d = solution_.data();
    Real* r = residual_.data();
    Real* p = direction_.data();
    Real* q = image_.data();
    const Real* inverse = inverse_.data();
    PcgSums now = parallelSum(pieceCount(), 1, [&](Index begin, Index end) {
      gather(kernels, begin, end);
      return kernels.precondition(pieces_[begin], pieces_[end], inverse, r, p);
    });
    now.rz += solveCoarse(kernels);
    const Real* move = coarse_move_.data();
    if (hasGroups())
    {
      parallelFor(pieceCount(), 1, [&](Index begin, Index end) {
        kernels.spread(groups_, pieces_[begin], pieces_[end], move, p);
      });
    }
    const double all = now.rr, enough = tolerance * tolerance * all;
    const int hopeless = 10 * static_cast<int>(n) + 100;
    int iteration = 0;
    while (now.rr > enough && iteration < std::min(most, hopeless))
    {
      ++iteration;
      double curvature = parallelSum(pieceCount(), 1, [&](Index begin, Index end) {
        return kernels.multiply(rows, pieces_[begin], pieces_[end], p, q);
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
      PcgSums next = parallelSum(pieceCount(), 1, [&](Index begin, Index end) {
        const PcgSums sums =
            kernels.advance(pieces_[begin], pieces_[end], inverse, step, p, d, r, q);
        gather(kernels, begin, end);
        return sums;
      });
      if (!std::isfinite(next.rr))  // singular, and no solution
      {
        solution_.assign(solution_.size(), Real(0));
        return {iteration, 1.0, true, false};
      }
      next.rz += solveCoarse(kernels);
      const Real ratio = static_cast<Real>(next.rz / now.rz);
      now = next;
      parallelFor(pieceCount(), 1, [&](Index begin, Index end) {
        if (hasGroups())
        {
          kernels.spread(groups_, pieces_[begin], pieces_[end], move, q);
        }
        kernels.turn(pieces_[begin], pieces_[end], ratio, q, p);
      });
    }
    return {iteration, std::sqrt(now.rr / all), !std::isfinite(now.rr),
            now.rr > enough && iteration == most};
  }

  /** Calls f(i) for all places of nodes. */
  template <typename Function>
  void forPlaces(const Function& f) const
  {
    parallelFor(pieceCount(), 1, [&](Index begin, Index end) {
      for (Index i = pieces_[begin]; i < pieces_[end]; ++i)
      {
        f(i);
      }
    });
  }

  Index pieceCount() const { return static_cast<Index>(pieces_.size()) - 1; }

  bool hasGroups() const { return group_pieces_.size() > 1; }

  /** The residual's sums over those pieces that are in groups. */
  void gather(const PcgKernels<Real>& kernels, Index begin, Index end)
  {
    kernels.gather(groups_, begin, std::min(end, group_pieces_.back()), residual_.data(),
                   gathered_.data());
  }

  /** Groups' moves for the residual that was gathered; its product with them. */
  double solveCoarse(const PcgKernels<Real>& kernels)
  {
    if (!hasGroups())
    {
      return 0.0;
    }
    std::fill(coarse_residual_.begin(), coarse_residual_.end(), Real(0));
    for (std::size_t g = 0; g + 1 < group_pieces_.size(); ++g)
    {
      for (Index piece = group_pieces_[g]; piece < group_pieces_[g + 1]; ++piece)
      {
        for (int k = 0; k < 6; ++k)
        {
          coarse_residual_[6 * g + k] += gathered_[6 * piece + k];
        }
      }
    }
    const auto size = static_cast<Index>(coarse_residual_.size());
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

  bool loaded_ = false, has_groups_ = false;
  std::vector<Index> nodes_, place_;       ///< the order, and each node's place in it
  std::vector<Index> group_;               ///< by places
  std::vector<Index> pieces_ = {0};        ///< of places: where each begins, and the end
  std::vector<Index> group_pieces_ = {0};  ///< group g: pieces group_pieces_[g] ...
  std::vector<Index> offsets_, columns_;   ///< the matrix's pattern that rows_ has
  PackedRows<Real> rows_;
  CouplingRows<Real> couplings_;
  OuterRows<Real> outer_;
  std::vector<Real> inverse_;  ///< of its diagonal blocks
  std::vector<Real> residual_, direction_, image_, solution_;
  NodeGroups<Real> groups_ = {};
  std::vector<Real> gathered_;  ///< by pieces, 6 each
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
      forgetGroups();
    }
  }

  LinearReport solve(const Points& b, double tolerance, int most_iterations, Points& d) override
  {
    return tolerance >= kSingleTolerance && !groups_.isUneven()
               ? single_.solve(*matrix_, groups_, b, tolerance, most_iterations, d)
               : double_.solve(*matrix_, groups_, b, tolerance, most_iterations, d);
  }

  void forget() override { groups_ = RigidGroups(); }

  void exchange(StateArchive& archive) override
  {
    groups_.exchange(archive);
    if (archive.reading())
    {
      forgetGroups();
    }
  }

  bool isUneven() const override { return groups_.isUneven(); }

 private:
  void forgetGroups()
  {
    single_.forgetGroups();
    double_.forgetGroups();
  }

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
