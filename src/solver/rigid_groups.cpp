#include "soft_tissue_sim/solver/rigid_groups.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "node_vectors.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/geometry/halving_order.h"
#include "stiff_parts.h"

namespace soft_tissue
{
namespace
{
/** Nodes a group has at least, and the most groups: the coarse matrix has to stay small. */
constexpr Index kNodesEach = 64;
constexpr Index kMostGroups = 40;
/** Share of its group's size a node may move beside the group's mean move, which changes no rigid
 * motion, before these are taken anew. */
constexpr double kOutdated = 0.25;
/** Factor by which couplings may get stronger or weaker before. */
constexpr double kOtherwise = 2.0;
/** Share of the largest diagonal number added to all: nodes in a line have no moment of inertia. */
constexpr double kShift = 1e-6;

/** Of the coarse matrix's inverse, per parallel piece. */
constexpr Index kColumns = 24;

using Matrix = Eigen::MatrixXd;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/** The strongest and the weakest hold of some nodes. */
struct Contrast
{
  double most = 0.0, least = std::numeric_limits<double>::infinity();

  Contrast& operator+=(const Contrast& other)
  {
    most = std::max(most, other.most);
    least = std::min(least, other.least);
    return *this;
  }
};

/** Whether blocks of A's pattern couple a node to others. */
bool isCoupled(const BlockMatrix& a, Index row)
{
  for (Index k = a.offsets()[row]; k < a.offsets()[row + 1]; ++k)
  {
    const Index upper = k < a.diagonal(row) ? a.mirror(k) : k;
    if (k != a.diagonal(row) && Eigen::Map<const Mat3>(a.block(upper)).squaredNorm() > 0.0)
    {
      return true;
    }
  }
  return false;
}

/** Groups of each body, by its share of the nodes; one body alone has several or none. */
std::vector<Index> groupCounts(const std::vector<std::vector<Index>>& bodies)
{
  std::size_t all = 0;
  for (const std::vector<Index>& body : bodies)
  {
    all += body.size();
  }
  std::vector<Index> counts;
  for (std::size_t k = 0; k < bodies.size(); ++k)
  {
    const auto size = static_cast<Index>(bodies[k].size());
    const Index share = static_cast<Index>(kMostGroups * bodies[k].size() / all);
    const Index wanted = std::min(size / kNodesEach, share);
    counts.push_back(bodies.size() == 1 ? (wanted < 2 ? 0 : wanted) : std::max<Index>(wanted, 1));
    if (static_cast<Index>(k) >= kMostGroups)
    {
      counts.back() = 0;
    }
  }
  return counts;
}

double couplingOf(const BlockMatrix& a)
{
  double sum = 0.0;
  for (const Coupling& coupling : a.couplings())
  {
    sum += coupling.block.norm();
  }
  return sum;
}

/** P_i^T B P_j for P = [I, -arm x]. */
Mat6 projected(const Mat3& b, const Vec3& arm_i, const Vec3& arm_j)
{
  Mat6 all;
  all.topLeftCorner<3, 3>() = b;
  for (int k = 0; k < 3; ++k)
  {
    // Row k of B (-arm_j x): the rotations' share of it.
    all.block<1, 3>(k, 3) = arm_j.cross(Vec3(b.row(k).transpose())).transpose();
  }
  for (int k = 0; k < 6; ++k)
  {
    all.block<3, 1>(3, k) = arm_i.cross(Vec3(all.block<3, 1>(0, k)));
  }
  return all;
}
}  // namespace

void RigidGroups::exchange(StateArchive& archive)
{
  archive.value(usable_);
  archive.list(offsets_);
  archive.list(nodes_);
  archive.list(group_);
  archive.list(sizes_);
  archive.list(arms_);
  archive.list(inverse_);
  archive.value(coupling_);
  archive.value(contrast_);
  archive.list(built_at_);
}

void RigidGroups::makeGroups(const BlockMatrix& a, const Points& x)
{
  offsets_ = {0};
  nodes_.clear();
  std::vector<std::vector<Index>> bodies = stiffAndSoftParts(a);
  const std::vector<Index> counts = groupCounts(bodies);
  std::vector<Index> sizes;
  for (std::size_t k = 0; k < bodies.size(); ++k)
  {
    if (counts[k] > 0)
    {
      halve(x, bodies[k].begin(), bodies[k].end(), counts[k],
            [&](auto begin, auto end, Index) { sizes.push_back(static_cast<Index>(end - begin)); });
      nodes_.insert(nodes_.end(), bodies[k].begin(), bodies[k].end());
    }
  }
  const auto count = static_cast<Index>(sizes.size());
  group_.assign(x.size(), count);
  for (Index g = 0; g < count; ++g)
  {
    const Index begin = offsets_.back(), end = begin + sizes[g];
    std::sort(nodes_.begin() + begin, nodes_.begin() + end);
    for (Index i = begin; i < end; ++i)
    {
      group_[nodes_[i]] = g;
    }
    offsets_.push_back(end);
  }
  for (Index node = 0; node < static_cast<Index>(x.size()); ++node)
  {
    if (group_[node] == count)
    {
      nodes_.push_back(node);
    }
  }
}

void RigidGroups::measureContrast(const BlockMatrix& a)
{
  const Contrast all = parallelSum(a.rows(), kNodeGrain, [&](Index begin, Index end) {
    Contrast part;
    for (Index row = begin; row < end; ++row)
    {
      // What is fixed, or in no element, has a row of the identity alone.
      if (a.offsets()[row + 1] - a.offsets()[row] > 1 && isCoupled(a, row))
      {
        const double hold = holdOf(a, row);
        part += {hold, hold};
      }
    }
    return part;
  });
  contrast_ = all.most > all.least && all.least > 0.0 ? all.most / all.least : 1.0;
}

double RigidGroups::evenness() const
{
  return std::min(1.0, kMostEven / contrast_);
}

void RigidGroups::placeArms(const Points& x)
{
  built_at_ = x;
  arms_.assign(3 * x.size(), 0.0);
  sizes_.assign(size(), 0.0);
  for (int g = 0; g < size(); ++g)
  {
    Vec3 centre = Vec3::Zero();
    for (Index i = offsets_[g]; i < offsets_[g + 1]; ++i)
    {
      centre += x[nodes_[i]] / (offsets_[g + 1] - offsets_[g]);
    }
    for (Index i = offsets_[g]; i < offsets_[g + 1]; ++i)
    {
      sizes_[g] = std::max(sizes_[g], (x[nodes_[i]] - centre).norm());
    }
    const double scale = sizes_[g] > 0.0 ? 1.0 / sizes_[g] : 0.0;
    for (Index i = offsets_[g]; i < offsets_[g + 1]; ++i)
    {
      Eigen::Map<Vec3>(arms_.data() + 3 * nodes_[i]) = scale * (x[nodes_[i]] - centre);
    }
  }
}

bool RigidGroups::outdated(const BlockMatrix& a, const Points& x) const
{
  const double coupling = couplingOf(a);
  if (!usable_ || x.size() != built_at_.size() || coupling > kOtherwise * coupling_ ||
      coupling * kOtherwise < coupling_)
  {
    return true;
  }
  return parallelSum(size(), 1, [&](Index begin, Index end) {
           int bent = 0;
           for (Index g = begin; g < end; ++g)
           {
             bent += isBent(g, x) ? 1 : 0;
           }
           return bent;
         }) > 0;
}

/** Whether the group's nodes have moved otherwise than all together since its arms were placed. */
bool RigidGroups::isBent(Index g, const Points& x) const
{
  const double far = kOutdated * evenness() * sizes_[g];
  Vec3 move = Vec3::Zero();
  for (Index i = offsets_[g]; i < offsets_[g + 1]; ++i)
  {
    move += x[nodes_[i]] - built_at_[nodes_[i]];
  }
  move /= offsets_[g + 1] - offsets_[g];
  return std::any_of(
      nodes_.begin() + offsets_[g], nodes_.begin() + offsets_[g + 1],
      [&](Index node) { return (x[node] - built_at_[node] - move).squaredNorm() > far * far; });
}

/** coarse += P^T (its blocks) P. */
void RigidGroups::addBlocks(const BlockMatrix& a, Eigen::MatrixXd& coarse) const
{
  // To the columns of row's group, and to its rows too where it is column's as well.
  const auto add = [&](Index row, Index column, const Mat3& b) {
    const Index g = group_[row], h = group_[column];
    if (g == size() || h == size())
    {
      return;
    }
    const Mat6 block = projected(b, Eigen::Map<const Vec3>(arms_.data() + 3 * row),
                                 Eigen::Map<const Vec3>(arms_.data() + 3 * column));
    coarse.block<6, 6>(6 * h, 6 * g) += block.transpose();
    if (g == h && column != row)
    {
      coarse.block<6, 6>(6 * g, 6 * g) += block;
    }
  };
  parallelFor(size(), 1, [&](Index begin, Index end) {
    for (Index i = offsets_[begin]; i < offsets_[end]; ++i)
    {
      const Index row = nodes_[i];
      for (Index k = a.diagonal(row); k < a.offsets()[row + 1]; ++k)
      {
        add(row, a.columns()[k], Eigen::Map<const Mat3>(a.block(k)));
      }
    }
  });
  for (const Coupling& coupling : a.couplings())
  {
    add(coupling.row, coupling.column, coupling.block);
  }
  for (int g = 0; g < size(); ++g)
  {
    for (int h = 0; h < g; ++h)
    {
      coarse.block<6, 6>(6 * g, 6 * h) += coarse.block<6, 6>(6 * h, 6 * g).transpose();
      coarse.block<6, 6>(6 * h, 6 * g) = coarse.block<6, 6>(6 * g, 6 * h).transpose();
    }
  }
}

/** coarse += P^T G^T D G P: each vector meets the few groups its nodes are in. */
void RigidGroups::addOuter(const OuterProducts& outer, Eigen::MatrixXd& coarse) const
{
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(coarse.rows());
  std::vector<Index> met;
  for (Index k = 0; k < outer.size(); ++k)
  {
    met.clear();
    for (Index place = outer.offsets()[k]; place < outer.offsets()[k + 1]; ++place)
    {
      const Index node = outer.nodes()[place], group = group_[node];
      if (group == size())
      {
        continue;
      }
      const Vec3 g = Eigen::Map<const Vec3>(outer.vector(place));
      sums.segment<3>(6 * group) += g;
      sums.segment<3>(6 * group + 3) += Eigen::Map<const Vec3>(arms_.data() + 3 * node).cross(g);
      if (std::find(met.begin(), met.end(), group) == met.end())
      {
        met.push_back(group);
      }
    }
    for (const Index g : met)
    {
      for (const Index h : met)
      {
        coarse.block<6, 6>(6 * g, 6 * h) +=
            outer.weights()[k] * sums.segment<6>(6 * g) * sums.segment<6>(6 * h).transpose();
      }
    }
    for (const Index g : met)
    {
      sums.segment<6>(6 * g).setZero();
    }
  }
}

void RigidGroups::build(const BlockMatrix& a, const Points& x)
{
  if (x.size() != built_at_.size())
  {
    makeGroups(a, x);
  }
  placeArms(x);
  measureContrast(a);
  coupling_ = couplingOf(a);
  Matrix coarse = Matrix::Zero(6 * size(), 6 * size());
  addBlocks(a, coarse);
  addOuter(a.outer(), coarse);
  if (size() > 0)
  {
    const double shift = kShift * evenness();
    coarse.diagonal().array() += shift * coarse.diagonal().maxCoeff();
  }
  const Eigen::LLT<Matrix> factor(coarse);
  usable_ = size() == 0 || factor.info() == Eigen::Success;
  inverse_.assign(coarse.size(), 0.0);
  if (usable_ && size() > 0)
  {
    const auto rows = static_cast<Index>(coarse.rows());
    Eigen::Map<Matrix> inverse(inverse_.data(), rows, rows);
    inverse.setIdentity();
    parallelFor(rows, kColumns, [&](Index begin, Index end) {
      auto columns = inverse.middleCols(begin, end - begin);
      factor.solveInPlace(columns);
    });
  }
}

}  // namespace soft_tissue
