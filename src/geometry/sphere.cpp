#include <cmath>

#include "feature_curvature.h"
#include "surface_grid.h"

namespace soft_tissue
{
namespace
{
/** Icosahedron on the unit sphere, outward. */
SurfaceMesh icosahedron()
{
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  SurfaceMesh mesh;
  mesh.nodes = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

class Sphere : public RigidShape
{
 public:
  explicit Sphere(double radius) : radius_(radius) {}

  SignedDistance distance(const Vec3& p) const override
  {
    const double from_centre = p.norm();
    return {from_centre - radius_, from_centre > 0.0 ? Vec3(p / from_centre) : Vec3::UnitZ()};
  }

  Mat3 curvature(const Vec3& p) const override { return aroundFeature(p, Mat3::Zero()); }

  Box3 bounds() const override { return {Vec3::Constant(-radius_), Vec3::Constant(radius_)}; }
  bool convex() const override { return true; }
  double innerRadius() const override { return radius_; }

  SurfaceMesh surface(double max_edge) const override
  {
    const SurfaceMesh base = icosahedron();
    // An icosahedron's edge is 1.0515 radii; its pieces grow where they are pushed out.
    for (int n = pieceCount(1.0515 * radius_, max_edge, 2);; ++n)
    {
      requireAffordable(20.0 * n * n, max_edge);
      SurfaceMesh mesh = subdivide(base, n);
      for (Vec3& node : mesh.nodes)
      {
        node *= radius_ / node.norm();
      }
      if (longestEdge(mesh) <= max_edge)
      {
        return mesh;
      }
    }
  }

 private:
  double radius_;
};
}  // namespace

std::shared_ptr<const RigidShape> makeSphere(double radius)
{
  requirePositive(radius, "sphere: radius_m");
  return std::make_shared<Sphere>(radius);
}

}  // namespace soft_tissue
