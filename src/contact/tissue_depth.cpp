#include "soft_tissue_sim/contact/tissue_depth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_tissue_sim/geometry/closest_point.h"

namespace soft_tissue
{
namespace
{
Adjacency trianglesOfTets(std::size_t tet_count, const std::vector<Index>& triangle_tet)
{
  Adjacency rows;
  rows.offsets.assign(tet_count + 1, 0);
  for (const Index tet : triangle_tet)
  {
    ++rows.offsets[tet + 1];
  }
  for (std::size_t t = 0; t < tet_count; ++t)
  {
    rows.offsets[t + 1] += rows.offsets[t];
  }
  rows.items.resize(triangle_tet.size());
  std::vector<Index> fill(rows.offsets.begin(), rows.offsets.end() - 1);
  for (std::size_t i = 0; i < triangle_tet.size(); ++i)
  {
    rows.items[fill[triangle_tet[i]]++] = static_cast<Index>(i);
  }
  return rows;
}

/** The triangles a search for the nearest boundary feature starts from, each once. */
struct Starts
{
  std::array<Index, 8> triangle;  // one per node and one per face of a tet
  int count = 0;

  void add(Index candidate)
  {
    if (candidate >= 0 && std::find(triangle.begin(), triangle.begin() + count, candidate) ==
                              triangle.begin() + count)
    {
      triangle[count++] = candidate;
    }
  }
};
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

TissueDepth::TissueDepth(const TissueBody& tissue, bool closest_feature)
    : tissue_(tissue),
      closest_feature_(closest_feature),
      tet_triangles_(trianglesOfTets(tissue.tets->size(), tissue.surface->triangle_tet))
{}

void TissueDepth::prepare(const Points& x)
{
  if (!closest_feature_)
  {
    return;
  }
  const std::vector<Triangle>& triangles = tissue_.surface->triangles;
  boxes_.resize(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i)
  {
    boxes_[i] = Box3();
    for (const Index node : triangles[i])
    {
      boxes_[i].extend(x[node]);
    }
  }
  if (tree_.empty())
  {
    tree_.build(boxes_);
  }
  else
  {
    tree_.refit(boxes_);
  }
}

bool TissueDepth::evaluate(const Vec3& p, Index tet, const TetCoordinates& coords, const Points& x,
                           const DistanceField& field, ContactSample& sample) const
{
  sample.position = p;
  const auto any = [](Index) { return true; };
  return closest_feature_ ? findFeature(p, tet, x, field, any, sample)
                          : interpolate(p, (*tissue_.tets)[tet], coords, field, sample);
}

bool TissueDepth::evaluateSelf(const Vec3& p, Index tet, const TetCoordinates& coords,
                               const Points& x, const DistanceField& field, const Points& rest,
                               const Vec3& rest_of, ContactSample& sample) const
{
  if (!closest_feature_)
  {
    return evaluate(p, tet, coords, x, field, sample);
  }
  const Tet& nodes = (*tissue_.tets)[tet];
  const Eigen::Vector4d weights = coords.weights(p);
  Vec3 place = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
  {
    place += weights[k] * rest[nodes[k]];
  }
  const Vec3 apart = rest_of - place;
  const double halfway = 0.5 * apart.dot(rest_of + place);
  const auto onThisSide = [&](Index i) {
    const Triangle& t = tissue_.surface->triangles[i];
    return apart.dot(rest[t[0]] + rest[t[1]] + rest[t[2]]) / 3.0 <= halfway;
  };
  sample.position = p;
  return findFeature(p, tet, x, field, onThisSide, sample);
}

DepthCurvature TissueDepth::curvature(const ContactSample& sample, const Points& x) const
{
  std::array<Vec3, 4> corners;
  for (int k = 0; k < (closest_feature_ ? 3 : 4); ++k)
  {
    corners[k] = x[sample.node[k] - tissue_.first_node];
  }
  return closest_feature_ ? featureCurvature(corners, sample) : interpolatedCurvature(corners);
}

bool TissueDepth::interpolate(const Vec3& p, const Tet& tet, const TetCoordinates& coords,
                              const DistanceField& field, ContactSample& sample) const
{
  const Eigen::Vector4d weights = coords.weights(p);
  Eigen::Vector4d depth;
  sample.count = 4;
  for (int k = 0; k < 4; ++k)
  {
    depth[k] = field.depth()[tet[k]];
    sample.node[k] = tissue_.first_node + tet[k];
    sample.coefficient[k] = -weights[k];
  }
  sample.depth = weights.dot(depth);
  sample.gradient = coords.gradients * depth;
  return true;
}

template <typename Allowed>
bool TissueDepth::findFeature(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                              const Allowed& allowed, ContactSample& sample) const
{
  Starts starts;
  for (const Index node : (*tissue_.tets)[tet])
  {
    starts.add(field.closestTriangle()[node]);
  }
  for (const Index* i = tet_triangles_.begin(tet); i != tet_triangles_.end(tet); ++i)
  {
    starts.add(*i);
  }
  const std::vector<Triangle>& triangles = tissue_.surface->triangles;
  const auto onTriangle = [&](Index i) {
    return closestOnTriangle(p, x[triangles[i][0]], x[triangles[i][1]], x[triangles[i][2]]);
  };
  Index nearest = -1;
  TrianglePoint found;
  found.squared_distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](Index i) {
    if (allowed(i))
    {
      const TrianglePoint point = onTriangle(i);
      if (point.squared_distance < found.squared_distance)
      {
        nearest = i;
        found = point;
      }
    }
    return found.squared_distance;
  };
  std::for_each(starts.triangle.begin(), starts.triangle.begin() + starts.count, consider);
  tree_.closest(p, consider, found.squared_distance);
  if (nearest < 0)  // nothing here is finite
  {
    return false;
  }
  const double distance = std::sqrt(found.squared_distance);
  const Triangle& triangle = triangles[nearest];
  sample.count = 3;
  for (int k = 0; k < 3; ++k)
  {
    sample.node[k] = tissue_.first_node + triangle[k];
    sample.coefficient[k] = -found.weights[k];
  }
  sample.depth = distance;
  // On the surface the direction is lost in rounding; there it is the triangle's own normal.
  constexpr double kOnSurface = 1e-10;
  const Vec3 side = x[triangle[1]] - x[triangle[0]];
  sample.gradient = distance > kOnSurface * side.norm()
                        ? Vec3((p - found.point) / distance)
                        : Vec3((x[triangle[2]] - x[triangle[0]]).cross(side).normalized());
  return true;
}

}  // namespace soft_tissue
