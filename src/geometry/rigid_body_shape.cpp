#include <algorithm>
#include <limits>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"

namespace soft_tissue
{
namespace
{
bool isRigid(const Pose& X)
{
  constexpr double kTolerance = 1e-9;
  const Mat3 rotation = X.linear();
  return X.matrix().allFinite() && rotation.determinant() > 0.0 &&
         (rotation.transpose() * rotation - Mat3::Identity()).cwiseAbs().maxCoeff() <= kTolerance;
}
}  // namespace

void RigidBodyShape::add(std::shared_ptr<const RigidShape> shape, const Pose& X_TS)
{
  if (!shape)
  {
    throw Error("rigid body: part " + std::to_string(parts_.size()) + " has no shape");
  }
  if (!isRigid(X_TS))
  {
    throw Error("rigid body: part " + std::to_string(parts_.size()) +
                " has a pose that is not a rotation and a finite translation");
  }
  parts_.push_back({std::move(shape), X_TS, X_TS.inverse()});
}

/** @param hint  of the only part, or null */
RigidBodyShape::Nearest RigidBodyShape::nearest(const Vec3& p_T, NearestHint* hint) const
{
  Nearest nearest;
  nearest.at.distance = std::numeric_limits<double>::infinity();
  for (const Part& part : parts_)
  {
    const Vec3 p_S = part.X_ST * p_T;
    const SignedDistance candidate = hint != nullptr && parts_.size() == 1
                                         ? part.shape->distance(p_S, *hint)
                                         : part.shape->distance(p_S);
    if (candidate.distance < nearest.at.distance)
    {
      nearest = {&part, candidate};
    }
  }
  return nearest;
}

SignedDistance RigidBodyShape::distanceTo(const Nearest& found) const
{
  SignedDistance at = found.at;
  if (found.part != nullptr)
  {
    at.normal = found.part->X_TS.linear() * at.normal;
  }
  return at;
}

SignedDistance RigidBodyShape::distance(const Vec3& p_T) const
{
  return distanceTo(nearest(p_T, nullptr));
}

SignedDistance RigidBodyShape::distance(const Vec3& p_T, NearestHint& hint) const
{
  return distanceTo(nearest(p_T, &hint));
}

Mat3 RigidBodyShape::curvature(const Vec3& p_T, NearestHint& hint) const
{
  const Part* part = parts_.size() == 1 ? parts_.data() : nearest(p_T, nullptr).part;
  if (part == nullptr)
  {
    return Mat3::Zero();
  }
  const Mat3 R_TS = part->X_TS.linear();
  return R_TS * part->shape->curvature(part->X_ST * p_T, hint) * R_TS.transpose();
}

Mat3 RigidBodyShape::curvature(const Vec3& p_T) const
{
  NearestHint unused;
  return curvature(p_T, unused);
}

Box3 RigidBodyShape::bounds() const
{
  Box3 box;
  for (const Part& part : parts_)
  {
    const Box3 own = part.shape->bounds();
    const Vec3 centre = part.X_TS * (0.5 * (own.min + own.max));
    const Vec3 half = part.X_TS.linear().cwiseAbs() * (0.5 * (own.max - own.min));
    box.extend(Box3{centre - half, centre + half});
  }
  return box;
}

double RigidBodyShape::innerRadius() const
{
  double least = parts_.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  for (const Part& part : parts_)
  {
    least = std::min(least, part.shape->innerRadius());
  }
  return least;
}

SurfaceMesh RigidBodyShape::surface(double max_edge) const
{
  SurfaceMesh all;
  for (const Part& part : parts_)
  {
    const SurfaceMesh own = part.shape->surface(max_edge);
    const Index first = static_cast<Index>(all.nodes.size());
    for (const Vec3& node : own.nodes)
    {
      all.nodes.push_back(part.X_TS * node);
    }
    for (const Triangle& t : own.triangles)
    {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return all;
}

}  // namespace soft_tissue
