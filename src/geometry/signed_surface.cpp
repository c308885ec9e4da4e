#include "signed_surface.h"

#include <cmath>
#include <utility>

#include "feature_curvature.h"

namespace soft_tissue
{
void SignedSurface::build(SurfaceMesh mesh, PseudoNormals normals, double on_surface)
{
  mesh_ = std::move(mesh);
  normals_ = std::move(normals);
  std::vector<Box3> boxes(mesh_.triangles.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    for (const Index node : mesh_.triangles[i])
    {
      boxes[i].extend(mesh_.nodes[node]);
    }
  }
  tree_.build(boxes);
  on_surface_ = on_surface * (bounds().max - bounds().min).norm();
}

TrianglePoint SignedSurface::closestOn(Index triangle, const Vec3& p) const
{
  const Triangle& t = mesh_.triangles[triangle];
  return closestOnTriangle(p, mesh_.nodes[t[0]], mesh_.nodes[t[1]], mesh_.nodes[t[2]]);
}

SignedSurface::Nearest SignedSurface::nearest(const Vec3& p, double bound) const
{
  Nearest nearest;
  nearest.at.squared_distance = bound;
  const auto measure = [&](Index triangle) {
    const Nearest here = nearestOn(triangle, p);
    if (here.isBefore(nearest))
    {
      nearest = here;
    }
    return kTied * here.at.squared_distance;
  };
  tree_.closest(p, measure, kTied * bound);
  return nearest;
}

SignedSurface::Nearest SignedSurface::nearestOn(Index triangle, const Vec3& p) const
{
  return {triangle, closestOn(triangle, p)};
}

const Vec3& SignedSurface::pseudoNormal(const Nearest& nearest) const
{
  const Vec3& weights = nearest.at.weights;
  for (int k = 0; k < 3; ++k)
  {
    const int second = (k + 1) % 3;
    const int third = (k + 2) % 3;
    if (weights[second] == 0.0 && weights[third] == 0.0)
    {
      return normals_.nodes[mesh_.triangles[nearest.triangle][k]];
    }
    if (weights[third] == 0.0 && weights[k] > 0.0 && weights[second] > 0.0)
    {
      return normals_.edges[3 * nearest.triangle + k];
    }
  }
  return normals_.faces[nearest.triangle];
}

SignedDistance SignedSurface::distance(const Vec3& p, const Nearest& nearest) const
{
  const Vec3 outward = pseudoNormal(nearest);
  const Vec3 offset = p - nearest.at.point;
  const double length = offset.norm();
  if (!(length > on_surface_))
  {
    return {offset.dot(outward) < 0.0 ? -length : length, outward};
  }
  const double sign = offset.dot(outward) < 0.0 ? -1.0 : 1.0;
  return {sign * length, sign / length * offset};
}

Mat3 SignedSurface::curvature(const Vec3& p, const Nearest& nearest) const
{
  const Vec3 offset = p - nearest.at.point;
  if (!(offset.norm() > on_surface_))
  {
    return Mat3::Zero();
  }
  const Triangle& t = mesh_.triangles[nearest.triangle];
  Mat3 straight = Mat3::Zero();
  switch ((nearest.at.weights.array() > 0.0).count())
  {
    case 3:
      return Mat3::Zero();
    case 2: {
      int apex = 0;
      nearest.at.weights.minCoeff(&apex);
      const Vec3 along =
          (mesh_.nodes[t[(apex + 1) % 3]] - mesh_.nodes[t[(apex + 2) % 3]]).normalized();
      straight = along * along.transpose();
      break;
    }
    default:
      break;
  }
  const double sign = offset.dot(pseudoNormal(nearest)) < 0.0 ? -1.0 : 1.0;
  return sign * aroundFeature(offset, straight);
}

}  // namespace soft_tissue
