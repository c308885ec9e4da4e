#include "soft_tissue_sim/geometry/morton_order.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace soft_tissue
{
namespace
{
/** The bits of a 21-bit number, two places apart. */
std::uint64_t spread(std::uint64_t v)
{
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}
}  // namespace

std::vector<Index> mortonOrder(const Points& points)
{
  Vec3 low = Vec3::Constant(1e300), high = -low;
  for (const Vec3& p : points)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double scale = 2097151.0 / std::max((high - low).maxCoeff(), 1e-300);
  std::vector<std::pair<std::uint64_t, Index>> keys;
  keys.reserve(points.size());
  for (const Vec3& p : points)
  {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      key |= spread(static_cast<std::uint64_t>(scale * (p[axis] - low[axis]))) << axis;
    }
    keys.emplace_back(key, static_cast<Index>(keys.size()));
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order;
  order.reserve(keys.size());
  for (const auto& key : keys)
  {
    order.push_back(key.second);
  }
  return order;
}

}  // namespace soft_tissue
