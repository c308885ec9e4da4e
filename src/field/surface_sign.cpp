#include "surface_sign.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace soft_tissue
{
namespace
{
bool isEdge(const Triangle& t)
{
  return t[1] == t[2];
}

double angleAt(const Vec3& corner, const Vec3& a, const Vec3& b)
{
  const Vec3 u = a - corner, v = b - corner;
  return std::atan2(u.cross(v).norm(), u.dot(v));
}
}  // namespace

SurfaceSign::SurfaceSign(const BoundarySurface& surface, const Points& x)
    : surface_(surface), nodes_(x.size(), Vec3::Zero())
{
  faces_.reserve(surface.triangles.size());
  for (const Triangle& t : surface.triangles)
  {
    const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    if (isEdge(t))  // the body is to the left
    {
      faces_.push_back(Vec3(b.y() - a.y(), a.x() - b.x(), 0.0).normalized());
      nodes_[t[0]] += faces_.back();
      nodes_[t[1]] += faces_.back();
      continue;
    }
    faces_.push_back((b - a).cross(c - a).normalized());
    nodes_[t[0]] += angleAt(a, b, c) * faces_.back();
    nodes_[t[1]] += angleAt(b, c, a) * faces_.back();
    nodes_[t[2]] += angleAt(c, a, b) * faces_.back();
  }
}

bool SurfaceSign::inside(const Vec3& p, Index triangle, const TrianglePoint& nearest) const
{
  return (p - nearest.point).dot(normal(triangle, nearest.weights)) < 0.0;
}

Vec3 SurfaceSign::normal(Index triangle, const Vec3& weights) const
{
  const Triangle& t = surface_.triangles[triangle];
  const auto on = (weights.array() != 0.0).count();
  if (on == 1)
  {
    int corner = 0;
    weights.maxCoeff(&corner);
    return nodes_[t[corner]];
  }
  if (on == 3 || isEdge(t))
  {
    return faces_[triangle];
  }
  int opposite = 0;
  weights.minCoeff(&opposite);
  const Index neighbour = surface_.triangle_neighbours[triangle][(opposite + 1) % 3];
  return neighbour < 0 ? faces_[triangle] : Vec3(faces_[triangle] + faces_[neighbour]);
}

}  // namespace soft_tissue
