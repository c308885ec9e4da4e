#include "soft_tissue_sim/solver/rigid_groups.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>

namespace soft_tissue
{
namespace
{
/** Nodes a group has at least, and the most groups: the coarse matrix has to stay small. */
constexpr Index kNodesEach = 64;
constexpr Index kMostGroups = 40;
/** Share of its group's size a node may move before rigid motions are taken anew. */
constexpr double kOutdated = 0.5;
/** Share of the largest diagonal number added to all: nodes in a line have no moment of inertia. */
constexpr double kShift = 1e-6;

using Matrix = Eigen::MatrixXd;
using Mat6 = Eigen::Matrix<double, 6, 6>;

/** Nodes that A couples to others: not the fixed ones. */
std::vector<Index> coupledNodes(const BlockMatrix& a)
{
  std::vector<char> coupled(a.rows(), 0);
  for (Index row = 0; row < a.rows(); ++row)
  {
    for (Index k = a.diagonal(row) + 1; k < a.offsets()[row + 1]; ++k)
    {
      if (std::any_of(a.block(k), a.block(k) + 9, [](double v) { return v != 0.0; }))
      {
        coupled[row] = coupled[a.columns()[k]] = 1;
      }
    }
  }
  std::vector<Index> nodes;
  for (Index row = 0; row < a.rows(); ++row)
  {
    if (coupled[row] != 0)
    {
      nodes.push_back(row);
    }
  }
  return nodes;
}

/** Halves the nodes [begin, end) across their longest side until there are `parts`; appends the
 * ends. */
void bisect(const Points& x, std::vector<Index>::iterator begin, std::vector<Index>::iterator end,
            Index parts, std::vector<Index>& sizes)
{
  if (parts == 1)
  {
    sizes.push_back(static_cast<Index>(end - begin));
    return;
  }
  Vec3 low = x[*begin], high = low;
  for (auto i = begin; i != end; ++i)
  {
    low = low.cwiseMin(x[*i]);
    high = high.cwiseMax(x[*i]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const Index left = parts / 2;
  const auto middle = begin + (end - begin) * left / parts;
  std::nth_element(begin, middle, end, [&](Index i, Index j) {
    return x[i][axis] < x[j][axis] || (x[i][axis] == x[j][axis] && i < j);
  });
  bisect(x, begin, middle, left, sizes);
  bisect(x, middle, end, parts - left, sizes);
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

void RigidGroups::makeGroups(const BlockMatrix& a, const Points& x)
{
  offsets_ = {0};
  nodes_ = coupledNodes(a);
  const Index count = std::min(static_cast<Index>(nodes_.size()) / kNodesEach, kMostGroups);
  if (count < 2)
  {
    nodes_.clear();
    group_.assign(x.size(), 0);
    return;
  }
  group_.assign(x.size(), count);
  std::vector<Index> sizes;
  bisect(x, nodes_.begin(), nodes_.end(), count, sizes);
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

bool RigidGroups::outdated(const Points& x) const
{
  if (!usable_ || x.size() != built_at_.size())
  {
    return true;
  }
  for (int g = 0; g < size(); ++g)
  {
    const double far = kOutdated * sizes_[g];
    for (Index i = offsets_[g]; i < offsets_[g + 1]; ++i)
    {
      if ((x[nodes_[i]] - built_at_[nodes_[i]]).squaredNorm() > far * far)
      {
        return true;
      }
    }
  }
  return false;
}

void RigidGroups::build(const BlockMatrix& a, const Points& x)
{
  if (x.size() != built_at_.size())
  {
    makeGroups(a, x);
  }
  placeArms(x);
  Matrix coarse = Matrix::Zero(6 * size(), 6 * size());
  for (Index row = 0; row < a.rows(); ++row)
  {
    const Index g = group_[row];
    if (g == size())
    {
      continue;
    }
    const Vec3 arm = Eigen::Map<const Vec3>(arms_.data() + 3 * row);
    for (Index k = a.diagonal(row); k < a.offsets()[row + 1]; ++k)
    {
      const Index column = a.columns()[k];
      const Index h = group_[column];
      if (h == size())
      {
        continue;
      }
      const Mat6 block = projected(Eigen::Map<const Mat3>(a.block(k)), arm,
                                   Eigen::Map<const Vec3>(arms_.data() + 3 * column));
      coarse.block<6, 6>(6 * g, 6 * h) += block;
      if (column != row)
      {
        coarse.block<6, 6>(6 * h, 6 * g) += block.transpose();
      }
    }
  }
  if (size() > 0)
  {
    coarse.diagonal().array() += kShift * coarse.diagonal().maxCoeff();
  }
  const Eigen::LLT<Matrix> factor(coarse);
  usable_ = size() == 0 || factor.info() == Eigen::Success;
  inverse_.assign(coarse.size(), 0.0);
  if (usable_ && size() > 0)
  {
    Eigen::Map<Matrix>(inverse_.data(), coarse.rows(), coarse.cols()) =
        factor.solve(Matrix::Identity(coarse.rows(), coarse.cols()));
  }
}

}  // namespace soft_tissue
