#include "soft_tissue_sim/geometry/tet_overlap.h"

#include <algorithm>
#include <cmath>

namespace soft_tissue
{
namespace
{
constexpr double kTouching = 1e-12;
/** Tets with less than this of (longest edge)^3 for six volumes also get the axes of flat ones. */
constexpr double kFlat = 1e-6;
/** Squares of shorter axes would be lost below the least number. */
constexpr double kLeastAxis = 1e-200;

using Corners = Eigen::Matrix<double, 3, 4>;
using Edges = Eigen::Matrix<double, 3, 6>;

Edges edgesOf(const Corners& p)
{
  Edges edges;
  edges << p.col(1) - p.col(0), p.col(2) - p.col(0), p.col(3) - p.col(0), p.col(2) - p.col(1),
      p.col(3) - p.col(1), p.col(3) - p.col(2);
  return edges;
}

bool isFlat(const Edges& edges)
{
  const double longest = edges.colwise().norm().maxCoeff();
  const double volume6 = edges.col(0).cross(edges.col(1)).dot(edges.col(2));
  return std::abs(volume6) <= kFlat * longest * longest * longest;
}

/** Two tets around the first one's first corner, the largest coordinate 1. */
struct Tets
{
  Corners a, b;

  bool apartAlong(const Vec3& axis) const
  {
    const double squared_norm = axis.squaredNorm();
    const Eigen::Matrix<double, 1, 4> on_a = axis.transpose() * a, on_b = axis.transpose() * b;
    const double gap =
        std::max(on_b.minCoeff() - on_a.maxCoeff(), on_a.minCoeff() - on_b.maxCoeff());
    return gap > 0.0 && squared_norm > kLeastAxis &&
           gap * gap > kTouching * kTouching * squared_norm;
  }
};

bool apartAcrossFaces(const Tets& tets, const Edges& edges)
{
  return tets.apartAlong(edges.col(0).cross(edges.col(1))) ||
         tets.apartAlong(edges.col(0).cross(edges.col(2))) ||
         tets.apartAlong(edges.col(1).cross(edges.col(2))) ||
         tets.apartAlong(edges.col(3).cross(edges.col(4)));
}

// The difference of two tets may be flat itself, a line or a point; then it has no faces, or one.
bool apartInPlane(const Tets& tets, const Edges& a, const Edges& b)
{
  const Vec3 between = tets.b.col(0) - tets.a.col(0);
  Eigen::Matrix<double, 3, 12> edges;
  edges << a, b;
  Vec3 normal = Vec3::Zero();  // the longest product: the one that rounding turned least
  for (int i = 0; i < 12; ++i)
  {
    for (int j = 0; j < i; ++j)
    {
      const Vec3 product = edges.col(i).cross(edges.col(j));
      normal = product.squaredNorm() > normal.squaredNorm() ? product : normal;
    }
  }
  bool apart = tets.apartAlong(between) || tets.apartAlong(normal);
  for (int i = 0; i < 12 && !apart; ++i)
  {
    const Vec3 edge = edges.col(i);
    apart = tets.apartAlong(edge) || tets.apartAlong(normal.cross(edge)) ||
            tets.apartAlong(edge.cross(between).cross(edge));
  }
  return apart;
}
}  // namespace

bool tetsOverlap(const std::array<Vec3, 4>& a, const std::array<Vec3, 4>& b)
{
  Tets tets;
  double farthest = 0.0;
  for (int k = 0; k < 4; ++k)
  {
    if (!a[k].allFinite() || !b[k].allFinite())
    {
      return false;
    }
    tets.a.col(k) = a[k] - a[0];
    tets.b.col(k) = b[k] - a[0];
    farthest = std::max(
        {farthest, tets.a.col(k).cwiseAbs().maxCoeff(), tets.b.col(k).cwiseAbs().maxCoeff()});
  }
  if (!(farthest > 0.0))
  {
    return true;  // one point
  }
  tets.a *= 1.0 / farthest;  // products of lengths neither overflow nor vanish
  tets.b *= 1.0 / farthest;
  const Edges edges_a = edgesOf(tets.a), edges_b = edgesOf(tets.b);
  if (apartAcrossFaces(tets, edges_a) || apartAcrossFaces(tets, edges_b))
  {
    return false;
  }
  for (int i = 0; i < 6; ++i)
  {
    for (int j = 0; j < 6; ++j)
    {
      if (tets.apartAlong(edges_a.col(i).cross(edges_b.col(j))))
      {
        return false;
      }
    }
  }
  return !(isFlat(edges_a) && isFlat(edges_b) && apartInPlane(tets, edges_a, edges_b));
}

}  // namespace soft_tissue
