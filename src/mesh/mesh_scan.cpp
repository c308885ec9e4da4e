#include "mesh_scan.h"

#include <cmath>

#include "soft_tissue_sim/mesh/check.h"

namespace soft_tissue
{
namespace
{
constexpr double kZeroShape = 1e-11;  ///< height over length below which a shape is flat
constexpr double kRounding = 1e-15;   ///< what scaling may have done to a coordinate, relative
}  // namespace

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
  const Vec3& a = nodes[triangle[0]];
  const Vec3 u = nodes[triangle[1]] - a;
  const Vec3 v = nodes[triangle[2]] - a;
  const double longest =
      std::sqrt(std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()}));
  const double rounding_m = kRounding * (a.cwiseAbs().maxCoeff() + longest);
  return u.cross(v).norm() <= std::max(kZeroShape * longest, rounding_m) * longest;
}

bool hasZeroVolume(const Points& nodes, const Tet& tet)
{
  const Vec3& a = nodes[tet[0]];
  const double quality = tetQuality(a, nodes[tet[1]], nodes[tet[2]], nodes[tet[3]]);
  const Vec3 u = nodes[tet[1]] - a;
  const Vec3 v = nodes[tet[2]] - a;
  const Vec3 w = nodes[tet[3]] - a;
  const double length = std::max({u.norm(), v.norm(), w.norm()});
  const double rounding_m = kRounding * (a.cwiseAbs().maxCoeff() + length);
  return !(std::abs(quality) > std::max(kZeroShape, rounding_m / length));
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
