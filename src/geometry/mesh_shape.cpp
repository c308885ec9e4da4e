#include <algorithm>
#include <cmath>

#include "closed_surface.h"
#include "signed_surface.h"
#include "soft_tissue_sim/geometry/triangle_tree.h"
#include "surface_grid.h"

namespace soft_tissue
{
namespace
{
/** Solid inside a closed triangle mesh. */
class MeshShape : public RigidShape
{
 public:
  MeshShape(const Points& nodes, const std::vector<Triangle>& triangles, const std::string& what)
  {
    SurfaceMesh mesh = {nodes, triangles};
    const std::vector<Index> twins = closedSurfaceTwins(mesh, what);
    PseudoNormals normals = pseudoNormals(mesh, twins);
    convex_ = isConvexSurface(mesh, twins, normals.faces);
    surface_.build(std::move(mesh), std::move(normals), 1e-12);
    tree_.build(surface_.mesh().triangles, surface_.mesh().nodes);
    inner_radius_ = climbed(largestTouchingBall());
  }

  SignedDistance distance(const Vec3& p) const override { return surface_.distance(p, closest(p)); }
  Mat3 curvature(const Vec3& p) const override { return surface_.curvature(p, closest(p)); }
  Box3 bounds() const override { return surface_.bounds(); }
  bool convex() const override { return convex_; }
  double innerRadius() const override { return inner_radius_; }
  SurfaceMesh surface(double max_edge) const override
  {
    return splitLongEdges(surface_.mesh(), max_edge);
  }

 private:
  SignedSurface::Nearest closest(const Vec3& p) const
  {
    // A point that is not finite is near to nothing.
    const Index nearest = tree_.nearest(p, surface_.mesh().nodes).triangle;
    return surface_.nearestOn(std::max<Index>(nearest, 0), p);
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
    const SurfaceMesh& mesh = surface_.mesh();
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    {
      const Triangle& t = mesh.triangles[i];
      const Vec3 start = (mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]]) / 3.0;
      const Vec3& outward = surface_.normals().faces[i];
      double radius = widest;
      for (int step = 0; step < kMostSteps && radius > largest.radius; ++step)
      {
        const Vec3 centre = start - radius * outward;
        const SignedSurface::Nearest nearest = closest(centre);
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

  SignedSurface surface_;
  TriangleTree tree_;  ///< over its mesh
  bool convex_ = false;
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
