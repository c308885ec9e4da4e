#include "closest_point_tree.h"

#include <cmath>

#ifdef SOFT_TISSUE_HAVE_CGAL
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#endif

namespace soft_tissue::studies
{
#ifdef SOFT_TISSUE_HAVE_CGAL
bool haveCgal()
{
  return true;
}

std::vector<double> cgalDistances(const Points& points, const std::vector<Triangle>& triangles,
                                  const Points& x)
{
  using Kernel = CGAL::Simple_cartesian<double>;
  using Corners = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Corners::const_iterator>;
  using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
  const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
  Corners corners;
  for (const Triangle& t : triangles)
  {
    corners.emplace_back(point(x[t[0]]), point(x[t[1]]), point(x[t[2]]));
  }
  Tree tree(corners.begin(), corners.end());
  tree.accelerate_distance_queries();
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Vec3& p : points)
  {
    distances.push_back(std::sqrt(tree.squared_distance(point(p))));
  }
  return distances;
}
#else
bool haveCgal()
{
  return false;
}

std::vector<double> cgalDistances(const Points&, const std::vector<Triangle>&, const Points&)
{
  return {};
}
#endif

}  // namespace soft_tissue::studies
