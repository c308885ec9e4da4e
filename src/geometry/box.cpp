#include <array>
#include <cmath>
#include <map>

#include "feature_curvature.h"
#include "surface_grid.h"

namespace soft_tissue
{
namespace
{
using Lattice = std::array<int, 3>;

class Box : public RigidShape
{
 public:
  explicit Box(const Vec3& size) : half_(0.5 * size) {}

  SignedDistance distance(const Vec3& p) const override
  {
    const Vec3 side(std::copysign(1.0, p.x()), std::copysign(1.0, p.y()),
                    std::copysign(1.0, p.z()));
    const Vec3 beyond = p.cwiseAbs() - half_;
    const Vec3 outward = beyond.cwiseMax(0.0);
    const double outside = outward.stableNorm();
    if (outside > 0.0)
    {
      return {outside, side.cwiseProduct(outward / outside)};
    }
    int axis = 0;
    const double depth = beyond.maxCoeff(&axis);
    return {depth, side[axis] * Vec3::Unit(axis)};
  }

  Mat3 curvature(const Vec3& p) const override
  {
    const Vec3 outward = (p.cwiseAbs() - half_).cwiseMax(0.0);
    if ((outward.array() > 0.0).count() < 2)
    {
      return Mat3::Zero();  // inside, or above a face
    }
    const Vec3 straight = (outward.array() == 0.0).cast<double>();
    return aroundFeature(p - p.cwiseMax(-half_).cwiseMin(half_), straight.asDiagonal());
  }

  Box3 bounds() const override { return {-half_, half_}; }
  bool convex() const override { return true; }
  double innerRadius() const override { return half_.minCoeff(); }

  SurfaceMesh surface(double max_edge) const override
  {
    const double cell = std::sqrt(0.5) * max_edge;  // so that diagonals are short enough too
    Lattice count;
    for (int axis = 0; axis < 3; ++axis)
    {
      count[axis] = pieceCount(2.0 * half_[axis], cell, 1);
    }
    const double per_side =
        1.0 * count[0] * count[1] + 1.0 * count[1] * count[2] + 1.0 * count[2] * count[0];
    requireAffordable(4.0 * per_side, max_edge);
    SurfaceMesh mesh;
    std::map<Lattice, Index> made;
    const auto nodeAt = [&](const Lattice& place) {
      const auto found = made.emplace(place, static_cast<Index>(mesh.nodes.size()));
      if (found.second)
      {
        Vec3 node;
        for (int axis = 0; axis < 3; ++axis)
        {
          const double from_centre = 2 * place[axis] - count[axis];
          node[axis] = half_[axis] * (from_centre / count[axis]);
        }
        mesh.nodes.push_back(node);
      }
      return found.first->second;
    };
    for (int axis = 0; axis < 3; ++axis)
    {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      for (int i = 0; i < count[u]; ++i)
      {
        for (int j = 0; j < count[v]; ++j)
        {
          for (const bool top : {false, true})
          {
            const auto corner = [&](int di, int dj) {
              Lattice place;
              place[axis] = top ? count[axis] : 0;
              place[u] = i + di;
              place[v] = j + dj;
              return nodeAt(place);
            };
            const Index a = corner(0, 0);
            const Index b = top ? corner(1, 0) : corner(0, 1);
            const Index c = corner(1, 1);
            const Index d = top ? corner(0, 1) : corner(1, 0);
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          }
        }
      }
    }
    return mesh;
  }

 private:
  Vec3 half_;
};
}  // namespace

std::shared_ptr<const RigidShape> makeBox(const Vec3& size)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    requirePositive(size[axis], std::string("box: size_m[") + std::to_string(axis) + "]");
  }
  return std::make_shared<Box>(size);
}

}  // namespace soft_tissue
