#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_tissue_sim/field/distance_field.h"
#include "soft_tissue_sim/geometry/closest_point.h"

namespace soft_tissue
{
namespace
{
/** One walk downhill from one triangle. */
struct Descent
{
  const Vec3& p;
  const Points& x;
  const BoundarySurface& surface;
  Index triangle;
  TrianglePoint at;

  Descent(const Vec3& point, const Points& positions, const BoundarySurface& boundary, Index start)
      : p(point), x(positions), surface(boundary), triangle(start), at(closestOn(start))
  {}

  TrianglePoint closestOn(Index candidate) const
  {
    const Triangle& t = surface.triangles[candidate];
    return closestOnTriangle(p, x[t[0]], x[t[1]], x[t[2]]);
  }

  /** Moves to the nearest of all triangles that share a node with this one, if it is nearer. */
  bool moves()
  {
    const Index before = triangle;
    for (const Index node : surface.triangles[before])
    {
      for (const Index* other = surface.node_triangles.begin(node);
           other != surface.node_triangles.end(node); ++other)
      {
        const TrianglePoint found = closestOn(*other);
        if (found.squared_distance < at.squared_distance)
        {
          triangle = *other;
          at = found;
        }
      }
    }
    return triangle != before;
  }
};
}  // namespace

BoundaryPoint descendToBoundary(const Vec3& p, const Points& x, const BoundarySurface& surface,
                                const Index* start_triangles, int start_count)
{
  BoundaryPoint nearest;
  double squared_distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < start_count; ++i)
  {
    const bool known =
        std::find(start_triangles, start_triangles + i, start_triangles[i]) != start_triangles + i;
    if (start_triangles[i] < 0 || known)
    {
      continue;
    }
    Descent descent(p, x, surface, start_triangles[i]);
    while (descent.moves())
    {}
    if (descent.at.squared_distance < squared_distance)
    {
      squared_distance = descent.at.squared_distance;
      nearest.triangle = descent.triangle;
      nearest.point = descent.at.point;
      nearest.weights = descent.at.weights;
    }
  }
  nearest.distance = std::sqrt(squared_distance);
  return nearest;
}

}  // namespace soft_tissue
