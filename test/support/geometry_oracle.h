#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "soft_tissue_sim/geometry/closest_point.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"

namespace soft_tissue::test
{
/** Reproducible random points, rotations and poses. */
class RandomGeometry
{
 public:
  explicit RandomGeometry(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high)
  {
    return low + (high - low) * (engine_() / 4294967296.0);
  }
  Vec3 point(double extent)
  {
    const double x = uniform(-extent, extent);
    const double y = uniform(-extent, extent);
    return {x, y, uniform(-extent, extent)};
  }
  Vec3 direction()
  {
    Vec3 p = point(1.0);
    while (p.norm() > 1.0 || p.norm() < 0.1)
    {
      p = point(1.0);
    }
    return p.normalized();
  }
  Pose pose(double extent)
  {
    Pose X = Pose::Identity();
    const Vec3 axis = direction();
    X.linear() = Eigen::AngleAxisd(uniform(-3.0, 3.0), axis).toRotationMatrix();
    X.translation() = point(extent);
    return X;
  }

 private:
  std::mt19937 engine_;
};

/** Least distance from p to any of n^2 / 2 sample points of a triangle: from above, by one cell. */
inline double sampledTriangleDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c,
                                      int n)
{
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; i + j <= n; ++j)
    {
      const Vec3 q = (i * a + j * b + (n - i - j) * c) / n;
      least = std::min(least, (p - q).norm());
    }
  }
  return least;
}

/** Least distance from p to a triangulation, one triangle after the other. */
inline double bruteForceDistance(const Vec3& p, const Points& x,
                                 const std::vector<Triangle>& triangles)
{
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : triangles)
  {
    least = std::min(least, closestOnTriangle(p, x[t[0]], x[t[1]], x[t[2]]).squared_distance);
  }
  return std::sqrt(least);
}

/** Turns of the surface around p: 1 inside a closed outward surface, 0 outside (solid angles). */
inline double windingNumber(const Vec3& p, const SurfaceMesh& mesh)
{
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
  {
    const Vec3 a = (mesh.nodes[t[0]] - p).normalized();
    const Vec3 b = (mesh.nodes[t[1]] - p).normalized();
    const Vec3 c = (mesh.nodes[t[2]] - p).normalized();
    sum += 2.0 * std::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return sum / (4.0 * 3.14159265358979323846);
}

/** Whether every edge is run exactly once in each direction: closed and consistently oriented. */
inline bool isClosed(const SurfaceMesh& mesh)
{
  std::map<std::pair<Index, Index>, int> runs;
  for (const Triangle& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      ++runs[{t[k], t[(k + 1) % 3]}];
    }
  }
  return std::all_of(runs.begin(), runs.end(), [&](const auto& run) {
    const auto back = runs.find({run.first.second, run.first.first});
    return run.second == 1 && back != runs.end() && back->second == 1;
  });
}

inline double surfaceArea(const SurfaceMesh& mesh)
{
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
  {
    const Vec3& a = mesh.nodes[t[0]];
    sum += 0.5 * (mesh.nodes[t[1]] - a).cross(mesh.nodes[t[2]] - a).norm();
  }
  return sum;
}

inline double enclosedVolume(const SurfaceMesh& mesh)
{
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles)
  {
    sum += mesh.nodes[t[0]].cross(mesh.nodes[t[1]]).dot(mesh.nodes[t[2]]) / 6.0;
  }
  return sum;
}

inline double longestEdgeOf(const SurfaceMesh& mesh)
{
  double longest = 0.0;
  for (const Triangle& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      longest = std::max(longest, (mesh.nodes[t[k]] - mesh.nodes[t[(k + 1) % 3]]).norm());
    }
  }
  return longest;
}

/** An L-shaped prism of arm length 2, thickness 1: reflex edge and saddle corners. */
inline SurfaceMesh lPrism()
{
  const std::vector<Eigen::Vector2d> outline = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  const std::vector<Triangle> cap = {{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}};
  SurfaceMesh mesh;
  for (const double z : {0.0, 1.0})
  {
    for (const Eigen::Vector2d& corner : outline)
    {
      mesh.nodes.emplace_back(corner.x(), corner.y(), z);
    }
  }
  for (const Triangle& t : cap)
  {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  for (Index i = 0; i < 6; ++i)
  {
    const Index j = (i + 1) % 6;
    mesh.triangles.push_back({i, j, j + 6});
    mesh.triangles.push_back({i, j + 6, i + 6});
  }
  return mesh;
}

}  // namespace soft_tissue::test
