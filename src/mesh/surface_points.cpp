#include "soft_tissue_sim/mesh/surface_points.h"

#include <algorithm>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
using Point = SurfacePoints::Point;

/** Half of each; both lie on one triangle of the mesh, so together they have three nodes at most.
 */
Point between(const Point& a, const Point& b)
{
  Point middle;
  int count = 0;
  for (const Point* end : {&a, &b})
  {
    for (int k = 0; k < 3; ++k)
    {
      if (end->weight[k] == 0.0)
      {
        continue;
      }
      int at = 0;
      while (at < count && middle.node[at] != end->node[k])
      {
        ++at;
      }
      count = std::max(count, at + 1);
      middle.node[at] = end->node[k];
      middle.weight[at] += 0.5 * end->weight[k];
    }
  }
  return middle;
}

Vec3 placeOf(const Point& point, const Points& x)
{
  return point.weight[0] * x[point.node[0]] + point.weight[1] * x[point.node[1]] +
         point.weight[2] * x[point.node[2]];
}

/** Appends the parts of a triangle of which some sides have a point in their middle, or -1. */
void cut(const Triangle& t, const std::array<Index, 3>& middle, const Points& at,
         std::vector<Triangle>& parts)
{
  const auto cuts = std::count_if(middle.begin(), middle.end(), [](Index m) { return m >= 0; });
  if (cuts == 0)
  {
    parts.push_back(t);
    return;
  }
  if (cuts == 3)
  {
    for (int k = 0; k < 3; ++k)
    {
      parts.push_back({t[k], middle[k], middle[(k + 2) % 3]});
    }
    parts.push_back({middle[0], middle[1], middle[2]});
    return;
  }
  if (cuts == 1)
  {
    int k = 0;
    while (middle[k] < 0)
    {
      ++k;
    }
    parts.push_back({t[k], middle[k], t[(k + 2) % 3]});
    parts.push_back({middle[k], t[(k + 1) % 3], t[(k + 2) % 3]});
    return;
  }
  int k = 0;  // the whole side
  while (middle[k] >= 0)
  {
    ++k;
  }
  const Index a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
  const Index bc = middle[(k + 1) % 3], ca = middle[(k + 2) % 3];
  parts.push_back({c, ca, bc});
  if ((at[bc] - at[a]).squaredNorm() <= (at[ca] - at[b]).squaredNorm())
  {
    parts.push_back({a, b, bc});
    parts.push_back({a, bc, ca});
  }
  else
  {
    parts.push_back({a, b, ca});
    parts.push_back({b, bc, ca});
  }
}
}  // namespace

SurfacePoints cutSurface(const TriMesh& rest, double longest_edge)
{
  if (!(longest_edge > 0.0))
  {
    throw Error("longest edge of a cut surface = " + std::to_string(longest_edge) +
                " m, must be > 0");
  }
  SurfacePoints out;
  for (std::size_t i = 0; i < rest.nodes.size(); ++i)
  {
    const auto node = static_cast<Index>(i);
    out.points.push_back({{node, node, node}, {1.0, 0.0, 0.0}});
  }
  Points at = rest.nodes;
  out.surface = surfaceOf(static_cast<Index>(at.size()), rest.triangles);
  for (bool any = true; any;)
  {
    std::vector<Index> middle(out.surface.edges.size(), -1);
    any = false;
    for (std::size_t e = 0; e < middle.size(); ++e)
    {
      const Edge& edge = out.surface.edges[e];
      if ((at[edge[1]] - at[edge[0]]).norm() > longest_edge)
      {
        any = true;
        middle[e] = static_cast<Index>(at.size());
        out.points.push_back(between(out.points[edge[0]], out.points[edge[1]]));
        at.push_back(placeOf(out.points.back(), rest.nodes));
      }
    }
    if (any)
    {
      std::vector<Triangle> parts;
      for (std::size_t t = 0; t < out.surface.triangles.size(); ++t)
      {
        const auto& sides = out.surface.triangle_edges[t];
        cut(out.surface.triangles[t], {middle[sides[0]], middle[sides[1]], middle[sides[2]]}, at,
            parts);
      }
      out.surface = surfaceOf(static_cast<Index>(at.size()), parts);
    }
  }
  return out;
}

void placePoints(const SurfacePoints& surface, const Points& x, Points& points)
{
  points.resize(surface.points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i] = placeOf(surface.points[i], x);
  }
}

}  // namespace soft_tissue
