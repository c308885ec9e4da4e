#include "stiff_parts.h"

#include <algorithm>

#include "soft_tissue_sim/base/union_find.h"

namespace soft_tissue
{
namespace
{
/** A coupling weaker than this share of what holds one of its nodes parts what is stiff from what
 * is soft; a body with more parts than this is taken as one. */
constexpr double kWeak = 1e-3;
constexpr std::size_t kMostParts = 8;

/**
 * Nodes that blocks of A's pattern couple to others, which the fixed ones are not: body by body.
 * @param weak  couplings weaker than this share of what holds one of their nodes join nothing
 */
std::vector<std::vector<Index>> coupledNodes(const BlockMatrix& a, double weak)
{
  UnionFind bodies(a.rows());
  std::vector<char> coupled(a.rows(), 0);
  for (Index row = 0; row < a.rows(); ++row)
  {
    for (Index k = a.diagonal(row) + 1; k < a.offsets()[row + 1]; ++k)
    {
      const Index column = a.columns()[k];
      const double strength = Eigen::Map<const Mat3>(a.block(k)).norm();
      if (strength > 0.0)
      {
        coupled[row] = coupled[column] = 1;
        if (strength >= weak * std::max(holdOf(a, row), holdOf(a, column)))
        {
          bodies.join(row, column);
        }
      }
    }
  }
  std::vector<std::vector<Index>> nodes;
  std::vector<Index> number(a.rows(), -1);  // per first node: which body
  for (Index row = 0; row < a.rows(); ++row)
  {
    if (coupled[row] != 0)
    {
      Index& body = number[bodies.find(row)];
      if (body < 0)
      {
        body = static_cast<Index>(nodes.size());
        nodes.emplace_back();
      }
      nodes[body].push_back(row);
    }
  }
  return nodes;
}
}  // namespace

double holdOf(const BlockMatrix& a, Index row)
{
  return Eigen::Map<const Mat3>(a.block(a.diagonal(row))).norm();
}

std::vector<std::vector<Index>> stiffAndSoftParts(const BlockMatrix& a)
{
  std::vector<std::vector<Index>> bodies = coupledNodes(a, 0.0);
  std::vector<std::vector<Index>> parts = coupledNodes(a, kWeak);
  return parts.size() > bodies.size() + kMostParts ? bodies : parts;
}

}  // namespace soft_tissue
