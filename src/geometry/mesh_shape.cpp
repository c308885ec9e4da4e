#include <algorithm>
#include <cmath>

#include "closed_surface.h"
#include "feature_curvature.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"
#include "soft_tissue_sim/geometry/closest_point.h"
#include "surface_grid.h"

namespace soft_tissue
{
namespace
{
/**
 * Solid inside a closed triangle mesh.
 *
 * Source: [Baerentzen2005] sign of the distance by angle-weighted pseudonormals.
 */
class MeshShape : public RigidShape
{
 public:
  MeshShape(const Points& nodes, const std::vector<Triangle>& triangles, const std::string& what)
  {
    mesh_.nodes = nodes;
    mesh_.triangles = triangles;
    const std::vector<Index> twins = closedSurfaceTwins(mesh_, what);
    normals_ = pseudoNormals(mesh_, twins);
    convex_ = isConvexSurface(mesh_, twins, normals_.faces);
    tree_.build(mesh_.triangles, mesh_.nodes);
    on_surface_ = 1e-12 * (bounds().max - bounds().min).norm();
    inner_radius_ = climbed(largestTouchingBall());
  }

  SignedDistance distance(const Vec3& p) const override
  {
    const Nearest nearest = closest(p);
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

  Mat3 curvature(const Vec3& p) const override
  {
    const Nearest nearest = closest(p);
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

  Box3 bounds() const override { return tree_.bounds(); }
  bool convex() const override { return convex_; }
  double innerRadius() const override { return inner_radius_; }
  SurfaceMesh surface(double max_edge) const override { return splitLongEdges(mesh_, max_edge); }

 private:
  struct Nearest
  {
    Index triangle;
    TrianglePoint at;
  };

  Nearest closest(const Vec3& p) const
  {
    const TriangleTree::Nearest nearest = tree_.nearest(p, mesh_.nodes);
    if (nearest.triangle >= 0)
    {
      return {nearest.triangle, nearest.point};
    }
    const Triangle& t = mesh_.triangles[0];  // a point that is not finite is near to nothing
    return {0, closestOnTriangle(p, mesh_.nodes[t[0]], mesh_.nodes[t[1]], mesh_.nodes[t[2]])};
  }

  const Vec3& pseudoNormal(const Nearest& nearest) const
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

  struct Ball
  {
    Vec3 centre;
    double radius;
  };

  /** The largest ball inside that touches the middle of a triangle, by shrinking. */
  Ball largestTouchingBall() const
  {
    constexpr int kMostSteps = 60;
    const double widest = (bounds().max - bounds().min).minCoeff() * 0.5;
    Ball largest{Vec3::Zero(), 0.0};
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i)
    {
      const Triangle& t = mesh_.triangles[i];
      const Vec3 start = (mesh_.nodes[t[0]] + mesh_.nodes[t[1]] + mesh_.nodes[t[2]]) / 3.0;
      const Vec3& outward = normals_.faces[i];
      double radius = widest;
      for (int step = 0; step < kMostSteps && radius > largest.radius; ++step)
      {
        const Vec3 centre = start - radius * outward;
        const Nearest nearest = closest(centre);
        if (std::sqrt(nearest.at.squared_distance) >= radius * (1.0 - 1e-9))
        {
          largest = {centre, radius};
          break;
        }
        const Vec3 across = start - nearest.at.point;
        const double along = across.dot(outward);
        radius = along > 0.0 ? std::min(0.5 * across.squaredNorm() / along, radius) : 0.0;
      }
    }
    return largest;
  }

  /** Depth at the top of the hill the ball's centre stands on, by a compass search. */
  double climbed(Ball ball) const
  {
    ball.radius = -distance(ball.centre).distance;
    for (double step = 0.5 * ball.radius; step > 1e-8 * ball.radius;)
    {
      Ball best = ball;
      for (int direction = 0; direction < 27; ++direction)
      {
        const Vec3 compass(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
        const Vec3 centre = ball.centre + step * compass;
        const double depth = -distance(centre).distance;
        if (depth > best.radius)
        {
          best = {centre, depth};
        }
      }
      step *= best.radius > ball.radius ? 1.0 : 0.5;
      ball = best;
    }
    return ball.radius;
  }

  SurfaceMesh mesh_;
  PseudoNormals normals_;
  TriangleTree tree_;
  bool convex_ = false;
  double on_surface_ = 0.0;
  double inner_radius_ = 0.0;
};
}  // namespace

std::shared_ptr<const RigidShape> makeMeshShape(const Points& nodes,
                                                const std::vector<Triangle>& triangles,
                                                const std::string& what)
{
  return std::make_shared<MeshShape>(nodes, triangles, what);
}

}  // namespace soft_tissue
