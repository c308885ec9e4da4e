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

/** Of an edge's length: nearer to a triangle a point is on it. */
constexpr double kOnSurface = 1e-10;
/** The tree is renewed when nodes are farther from it than this, in short edges. */
constexpr double kStale = 0.1;

int nearestCorner(const Vec3& p, const Tet& tet, const Points& x)
{
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k)
  {
    const double squared = (x[tet[k]] - p).squaredNorm();
    if (squared < least)
    {
      least = squared;
      nearest = k;
    }
  }
  return nearest;
}

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
  const std::vector<Index>& nodes = tissue_.surface->nodes;
  double squared = 0.0;
  for (std::size_t i = 0; i < tree_nodes_.size(); ++i)
  {
    squared = std::max(squared, (x[nodes[i]] - tree_nodes_[i]).squaredNorm());
  }
  moved_ = std::sqrt(squared);
  if (!tree_.empty() && moved_ <= kStale * tissue_.short_edge)
  {
    return;
  }
  tree_nodes_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    tree_nodes_[i] = x[nodes[i]];
  }
  if (tree_.empty())
  {
    tree_.build(tissue_.surface->triangles, x);
    built_nodes_ = tree_nodes_;
  }
  else
  {
    tree_.refit(x);
  }
  moved_ = 0.0;
}

// Of triangles equally near the tree decides, which keeps the shape it was built with.
void TissueDepth::exchange(StateArchive& archive)
{
  archive.list(built_nodes_);
  archive.list(tree_nodes_);
  if (!archive.reading())
  {
    return;
  }
  tree_ = TriangleTree();
  const auto all = [&](const Points& nodes) {
    Points x(tissue_.node_count, Vec3::Zero());
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
      x.at(tissue_.surface->nodes.at(i)) = nodes[i];
    }
    return x;
  };
  if (!built_nodes_.empty())
  {
    tree_.build(tissue_.surface->triangles, all(built_nodes_));
    tree_.refit(all(tree_nodes_));
  }
}

bool TissueDepth::evaluate(const Vec3& p, Index tet, const TetCoordinates& coords, const Points& x,
                           const DistanceField& field, Index& near, ContactSample& sample) const
{
  sample.position = p;
  const auto any = [](Index) { return true; };
  return closest_feature_ ? findFeature(p, tet, x, field, any, near, sample)
                          : interpolate(p, (*tissue_.tets)[tet], coords, field, sample);
}

bool TissueDepth::evaluateSelf(const Vec3& p, Index tet, const TetCoordinates& coords,
                               const Points& x, const DistanceField& field, const Points& rest,
                               const Vec3& rest_of, Index& near, ContactSample& sample) const
{
  if (!closest_feature_)
  {
    return evaluate(p, tet, coords, x, field, near, sample);
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
  return findFeature(p, tet, x, field, onThisSide, near, sample);
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

/** What is on a triangle of its own tet, as the ends of clipped edges are, needs no search. */
template <typename Allowed>
Index TissueDepth::nearestTriangle(const Vec3& p, Index tet, const Points& x,
                                   const DistanceField& field, Index near,
                                   const Allowed& allowed) const
{
  Index hint = near;
  for (const Index* own = tet_triangles_.begin(tet); own != tet_triangles_.end(tet); ++own)
  {
    const Triangle& t = tissue_.surface->triangles[*own];
    const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    const double near = kOnSurface * (b - a).norm();
    if (allowed(*own) && closestOnTriangle(p, a, b, c).squared_distance <= near * near)
    {
      return *own;
    }
    hint = hint < 0 ? *own : hint;
  }
  if (hint < 0)
  {
    const Tet& nodes = (*tissue_.tets)[tet];
    hint = field.closestTriangle()[nodes[nearestCorner(p, nodes, x)]];
  }
  return tree_.nearestOf(p, x, hint, moved_, allowed).triangle;
}

template <typename Allowed>
bool TissueDepth::findFeature(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                              const Allowed& allowed, Index& near, ContactSample& sample) const
{
  const std::vector<Triangle>& triangles = tissue_.surface->triangles;
  near = nearestTriangle(p, tet, x, field, near, allowed);
  if (near < 0)  // nothing here is finite
  {
    return false;
  }
  const Triangle& triangle = triangles[near];
  const TrianglePoint found = closestOnTriangle(p, x[triangle[0]], x[triangle[1]], x[triangle[2]]);
  const double distance = std::sqrt(found.squared_distance);
  sample.count = 3;
  for (int k = 0; k < 3; ++k)
  {
    sample.node[k] = tissue_.first_node + triangle[k];
    sample.coefficient[k] = -found.weights[k];
  }
  sample.depth = distance;
  // There the direction is lost in rounding: it is the triangle's own normal.
  const Vec3 side = x[triangle[1]] - x[triangle[0]];
  sample.gradient = distance > kOnSurface * side.norm()
                        ? Vec3((p - found.point) / distance)
                        : Vec3((x[triangle[2]] - x[triangle[0]]).cross(side).normalized());
  return true;
}

}  // namespace soft_tissue
