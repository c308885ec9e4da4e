#include "distance_volume.h"

#ifdef SOFT_TISSUE_HAVE_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <limits>
#endif

namespace soft_tissue::studies
{
#ifdef SOFT_TISSUE_HAVE_OPENVDB
bool haveOpenVdb()
{
  return true;
}

std::vector<double> openVdbDepths(const Points& points, const std::vector<Triangle>& triangles,
                                  const Points& x, double voxel)
{
  static const bool initialised = (openvdb::initialize(), true);
  static_cast<void>(initialised);
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
  std::vector<openvdb::Vec3s> corners;
  for (const Vec3& p : x)  // in voxels
  {
    corners.emplace_back(p.x() / voxel, p.y() / voxel, p.z() / voxel);
  }
  std::vector<openvdb::Vec3I> faces;
  for (const Triangle& t : triangles)
  {
    faces.emplace_back(t[0], t[1], t[2]);
  }
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(corners,
                                                                                        faces);
  constexpr float kOutside = 2.0F;  // voxels; all of the inside
  const auto volume = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      mesh, *transform, kOutside, std::numeric_limits<float>::max());
  std::vector<double> depths;
  depths.reserve(points.size());
  const auto values = volume->getConstAccessor();
  for (const Vec3& p : points)
  {
    depths.push_back(-openvdb::tools::BoxSampler::sample(
        values, openvdb::Vec3R(p.x() / voxel, p.y() / voxel, p.z() / voxel)));
  }
  return depths;
}
#else
bool haveOpenVdb()
{
  return false;
}

std::vector<double> openVdbDepths(const Points&, const std::vector<Triangle>&, const Points&,
                                  double)
{
  return {};
}
#endif

}  // namespace soft_tissue::studies
