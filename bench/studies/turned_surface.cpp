#include "turned_surface.h"

#include <cmath>

namespace soft_tissue::studies
{
TriMesh turnedSurface(const Points& line, int around, bool closed)
{
  TriMesh mesh;
  std::vector<std::vector<Index>> rings;
  for (const Vec3& p : line)
  {
    std::vector<Index> ring(around, static_cast<Index>(mesh.nodes.size()));  // a pole is one node
    for (int k = 0; k < (p.x() > 0.0 ? around : 1); ++k)
    {
      const double angle = 2.0 * M_PI * k / around;
      ring[k] = static_cast<Index>(mesh.nodes.size());
      mesh.nodes.emplace_back(p.x() * std::cos(angle), p.x() * std::sin(angle), p.z());
    }
    rings.push_back(ring);
  }
  const auto add = [&](Index a, Index b, Index c) {
    if (a != b && b != c && c != a)
    {
      mesh.triangles.push_back({a, b, c});
    }
  };
  for (std::size_t i = 0; i + (closed ? 0 : 1) < rings.size(); ++i)
  {
    const std::vector<Index>&low = rings[i], &high = rings[(i + 1) % rings.size()];
    for (int k = 0; k < around; ++k)
    {
      const int next = (k + 1) % around;
      add(low[k], low[next], high[next]);
      add(low[k], high[next], high[k]);
    }
  }
  return mesh;
}

}  // namespace soft_tissue::studies
