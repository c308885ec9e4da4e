#include "mesh_scan.h"

#include <cmath>

#include "soft_tissue_sim/mesh/check.h"

namespace soft_tissue
{
std::vector<Index> firstAtSamePlace(const Points& nodes)
{
  std::vector<Index> order(nodes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](Index a, Index b) {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (nodes[a][axis] != nodes[b][axis])
      {
        return nodes[a][axis] < nodes[b][axis];
      }
    }
    return a < b;
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<Index> first(nodes.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const bool repeated = i > 0 && nodes[order[i]] == nodes[order[i - 1]];
    first[order[i]] = repeated ? first[order[i - 1]] : order[i];
  }
  return first;
}

std::size_t countRepeated(const std::vector<Index>& first)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < first.size(); ++i)
  {
    count += first[i] != static_cast<Index>(i) ? 1 : 0;
  }
  return count;
}

bool hasZeroArea(const Points& nodes, const Triangle& triangle)
{
  const Vec3 u = nodes[triangle[1]] - nodes[triangle[0]];
  const Vec3 v = nodes[triangle[2]] - nodes[triangle[0]];
  const double longest2 = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  return 0.5 * u.cross(v).norm() <= kZeroArea * longest2;
}

bool hasZeroVolume(const Points& nodes, const Tet& tet)
{
  constexpr double kZeroQuality = 1e-11;
  return !(std::abs(tetQuality(nodes[tet[0]], nodes[tet[1]], nodes[tet[2]], nodes[tet[3]])) >
           kZeroQuality);
}

Vec3 boxSize(const Points& nodes)
{
  if (nodes.empty())
  {
    return Vec3::Zero();
  }
  Vec3 low = nodes[0];
  Vec3 high = nodes[0];
  for (const Vec3& node : nodes)
  {
    low = low.cwiseMin(node);
    high = high.cwiseMax(node);
  }
  return high - low;
}

}  // namespace soft_tissue
