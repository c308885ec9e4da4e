#include "soft_tissue_sim/contact/depth_curvature.h"

#include <Eigen/Geometry>

#include "soft_tissue_sim/contact/tissue_depth.h"

namespace soft_tissue
{
namespace
{
/** Depth linear in a tet that keeps its nodal depths: it bends as the tet is deformed. */
DepthCurvature interpolatedCurvature(const std::array<Vec3, 4>& corners)
{
  DepthCurvature curvature;
  curvature.distance = false;
  const auto coords = tetCoordinates(corners[0], corners[1], corners[2], corners[3]);
  for (int k = 0; k < 4 && coords; ++k)
  {
    curvature.turn[k] = coords->gradients.col(k);
  }
  return curvature;
}

/** Distance to the part of a triangle where the weights of the nearest point are not zero. */
DepthCurvature featureCurvature(const std::array<Vec3, 4>& corners, const ContactSample& sample)
{
  std::array<int, 3> on;
  int count = 0;
  for (int k = 0; k < 3; ++k)
  {
    if (sample.coefficient[k] != 0.0)
    {
      on[count++] = k;
    }
  }
  DepthCurvature curvature;
  const Vec3& g = sample.gradient;
  if (count == 3)
  {
    const Vec3 normal =
        (corners[1] - corners[0]).cross(Vec3(corners[2] - corners[0]));  // twice the area long
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 opposite = corners[(k + 2) % 3] - corners[(k + 1) % 3];
      curvature.turn[k] = normal.cross(opposite) / normal.squaredNorm();
    }
    return curvature;
  }
  curvature.bend = Mat3::Identity() - g * g.transpose();
  if (count == 2)
  {
    const Vec3 along = corners[on[1]] - corners[on[0]];
    const double squared = along.squaredNorm();
    curvature.bend -= along * along.transpose() / squared;
    curvature.turn[on[1]] = along / squared;
    curvature.turn[on[0]] = -curvature.turn[on[1]];
  }
  return curvature;
}
}  // namespace

DepthCurvature TissueDepth::curvature(const ContactSample& sample, const Points& x) const
{
  std::array<Vec3, 4> corners;
  for (int k = 0; k < (closest_feature_ ? 3 : 4); ++k)
  {
    corners[k] = x[sample.node[k] - tissue_.first_node];
  }
  return closest_feature_ ? featureCurvature(corners, sample) : interpolatedCurvature(corners);
}

}  // namespace soft_tissue
