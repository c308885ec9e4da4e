#include <algorithm>
#include <cmath>

#include "feature_curvature.h"
#include "surface_grid.h"

namespace soft_tissue
{
namespace
{
constexpr double kPi = 3.14159265358979323846;

/** Builds a capsule's surface ring by ring: `n` rings a hemisphere, ring k of it with 4 k nodes. */
class CapsuleMesher
{
 public:
  CapsuleMesher(double radius, double half_length, int n, int tube_rows)
      : radius_(radius), half_length_(half_length), n_(n)
  {
    addHemisphere(-1.0);
    Index ring = equator_;
    addHemisphere(1.0);
    const Index top = equator_;
    for (int row = 1; row <= tube_rows; ++row)
    {
      const double z = half_length * (2.0 * row / tube_rows - 1.0);
      const Index next = row < tube_rows ? addRing(n, radius, z) : top;
      joinTube(ring, next);
      ring = next;
    }
  }

  SurfaceMesh mesh;

 private:
  Index addRing(int quarter, double ring_radius, double z)
  {
    const Index first = static_cast<Index>(mesh.nodes.size());
    for (int i = 0; i < 4 * quarter; ++i)
    {
      const double angle = 0.5 * kPi * i / quarter;
      mesh.nodes.emplace_back(ring_radius * std::cos(angle), ring_radius * std::sin(angle), z);
    }
    return first;
  }

  void addTriangle(Index a, Index b, Index c, bool upper)
  {
    mesh.triangles.push_back(upper ? Triangle{a, b, c} : Triangle{a, c, b});
  }

  /** From the pole to the equator; up = 1 or -1. A straight part of length 0 shares the equator. */
  void addHemisphere(double up)
  {
    Index inner = static_cast<Index>(mesh.nodes.size());
    mesh.nodes.emplace_back(0.0, 0.0, up * (half_length_ + radius_));
    for (int k = 1; k <= n_; ++k)
    {
      const double angle = 0.5 * kPi * k / n_;
      const bool shared = up > 0.0 && k == n_ && half_length_ == 0.0;
      const Index outer = shared ? equator_
                                 : addRing(k, radius_ * std::sin(angle),
                                           up * (half_length_ + radius_ * std::cos(angle)));
      for (int quarter = 0; quarter < 4; ++quarter)
      {
        joinQuarter(inner, outer, k, quarter, up > 0.0);
      }
      inner = outer;
    }
    equator_ = inner;
  }

  /** Ring k has k + 1 nodes a quarter, the one inside it k, ends counted in both. */
  void joinQuarter(Index inner, Index outer, int k, int quarter, bool upper)
  {
    const int inner_count = std::max(1, 4 * (k - 1));
    for (int i = 0; i < k; ++i)
    {
      const Index out_0 = outer + quarter * k + i;
      const Index out_1 = outer + (quarter * k + i + 1) % (4 * k);
      const Index in_0 = inner + (quarter * (k - 1) + i) % inner_count;
      addTriangle(in_0, out_0, out_1, upper);
      if (i < k - 1)
      {
        addTriangle(in_0, out_1, inner + (quarter * (k - 1) + i + 1) % inner_count, upper);
      }
    }
  }

  void joinTube(Index lower, Index upper)
  {
    for (int i = 0; i < 4 * n_; ++i)
    {
      const int next = (i + 1) % (4 * n_);
      mesh.triangles.push_back({lower + i, lower + next, upper + next});
      mesh.triangles.push_back({lower + i, upper + next, upper + i});
    }
  }

  double radius_;
  double half_length_;
  int n_;
  Index equator_ = -1;
};

class Capsule : public RigidShape
{
 public:
  Capsule(double radius, double length) : radius_(radius), half_length_(0.5 * length) {}

  SignedDistance distance(const Vec3& p) const override
  {
    const Vec3 on_axis(0.0, 0.0, std::clamp(p.z(), -half_length_, half_length_));
    const Vec3 from_axis = p - on_axis;
    const double norm = from_axis.norm();
    return {norm - radius_, norm > 0.0 ? Vec3(from_axis / norm) : Vec3::UnitX()};
  }

  Mat3 curvature(const Vec3& p) const override
  {
    const double beyond = std::abs(p.z()) - half_length_;
    const Vec3 z = Vec3::UnitZ();
    return beyond > 0.0
               ? aroundFeature({p.x(), p.y(), beyond * (p.z() < 0.0 ? -1.0 : 1.0)}, Mat3::Zero())
               : aroundFeature({p.x(), p.y(), 0.0}, z * z.transpose());
  }

  Box3 bounds() const override
  {
    const Vec3 half(radius_, radius_, radius_ + half_length_);
    return {-half, half};
  }
  bool convex() const override { return true; }
  double innerRadius() const override { return radius_; }

  SurfaceMesh surface(double max_edge) const override
  {
    for (int n = pieceCount(0.5 * kPi * radius_, max_edge, 2);; ++n)
    {
      // The diagonal of a tube cell counts too: its other side is a chord of the equator.
      const double chord = 2.0 * radius_ * std::sin(kPi / (4 * n));
      const double height = std::sqrt(std::max(0.0, max_edge * max_edge - chord * chord));
      if (!(height > 0.0))
      {
        continue;
      }
      const int rows = half_length_ > 0.0 ? pieceCount(2.0 * half_length_, height, 1) : 0;
      requireAffordable(8.0 * n * n + 8.0 * n * rows, max_edge);
      SurfaceMesh mesh = CapsuleMesher(radius_, half_length_, n, rows).mesh;
      if (longestEdge(mesh) <= max_edge)
      {
        return mesh;
      }
    }
  }

 private:
  double radius_;
  double half_length_;
};
}  // namespace

std::shared_ptr<const RigidShape> makeCapsule(double radius, double length)
{
  requirePositive(radius, "capsule: radius_m");
  requireNotNegative(length, "capsule: length_m");
  return std::make_shared<Capsule>(radius, length);
}

}  // namespace soft_tissue
