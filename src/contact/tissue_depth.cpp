#include "soft_tissue_sim/contact/tissue_depth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "body_motion.h"
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

/** Counted farther than this in all, m or m^2, a small motion would be lost in rounding. */
constexpr double kFarthestTravel = 1.0;
/** How much farther than the nearest triangle those in lists are, in short edges. */
constexpr double kListed = 0.25;
/** How far a place of self-contact may slide, at rest, before it is searched for anew, in short
 * edges. */
constexpr double kSlid = 0.05;
/** Of a list's radius, or of a bound: rounding of what is compared with it. */
constexpr double kRounding = 1e-9;

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
  travelTo(x);
  motion_ = motionBetween(tree_nodes_, travel_.nodes);
  if (!tree_.empty() && motion_.rest <= kStale * tissue_.short_edge)
  {
    return;
  }
  tree_nodes_ = travel_.nodes;
  if (tree_.empty())
  {
    tree_.build(tissue_.surface->triangles, x);
    built_nodes_ = tree_nodes_;
  }
  else
  {
    tree_.refit(x);
  }
  motion_ = NodeMotion();
}

void TissueDepth::travelTo(const Points& x)
{
  now_.clear();
  for (const Index node : tissue_.surface->nodes)
  {
    now_.push_back(x[node]);
  }
  const NodeMotion step = motionBetween(travel_.nodes, now_);
  travel_.shift += step.shift;
  travel_.most += step.rest;
  if (!(travel_.most < kFarthestTravel && travel_.shift.squaredNorm() < kFarthestTravel))
  {
    ++travel_.number;
    travel_.shift.setZero();
    travel_.most = 0.0;
  }
  travel_.nodes.swap(now_);
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

bool TissueDepth::evaluate(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                           NearBoundary& near, ContactSample& sample) const
{
  sample.position = p;
  if (!closest_feature_)
  {
    return interpolate(p, tet, x, field, sample);
  }
  const auto any = [](Index) { return true; };
  TriangleTree::Nearest found = onOwnTriangle(p, tet, x, any);
  if (found.triangle < 0)
  {
    found = listed(p, x, near, any);
  }
  if (found.triangle < 0)
  {
    const Index hint = hintFor(p, tet, x, field, near.hint);
    found = tree_.shortlist(p, x, hint, motion_, kListed * tissue_.short_edge, near.list);
    remember(p, near);
  }
  near.hint = found.triangle;
  return takeFeature(p, found, x, sample);
}

bool TissueDepth::evaluateSelf(const Vec3& p, Index tet, const Points& x,
                               const DistanceField& field, const Points& rest, const Vec3& rest_of,
                               NearBoundary& near, ContactSample& sample) const
{
  sample.position = p;
  if (!closest_feature_)
  {
    return interpolate(p, tet, x, field, sample);
  }
  const auto coords = coordinates(tet, x);
  if (!coords)
  {
    return false;
  }
  const Tet& nodes = (*tissue_.tets)[tet];
  const Eigen::Vector4d weights = coords->weights(p);
  Vec3 place = Vec3::Zero();
  for (int k = 0; k < 4; ++k)
  {
    place += weights[k] * rest[nodes[k]];
  }
  const Vec3 apart = rest_of - place;
  const double halfway = 0.5 * apart.dot(rest_of + place);
  const auto centre = [&](Index i) {
    const Triangle& t = tissue_.surface->triangles[i];
    return Vec3((rest[t[0]] + rest[t[1]] + rest[t[2]]) / 3.0);
  };
  const auto onThisSide = [&](Index i) { return apart.dot(centre(i)) <= halfway; };
  TriangleTree::Nearest found = onOwnTriangle(p, tet, x, onThisSide);
  const double slid = kSlid * tissue_.short_edge;
  if (found.triangle < 0 &&
      (rest_of - near.rest_point).norm() + (place - near.rest_place).norm() <= slid)
  {
    found = listed(p, x, near, onThisSide);
  }
  if (found.triangle < 0)
  {
    // What may be on this side when both have slid by no more than that.
    const Vec3 middle = 0.5 * (rest_of + place);
    const auto mayBe = [&](Index i) {
      const Vec3 from_middle = centre(i) - middle;
      const double turn = slid * (from_middle.norm() + 0.5 * (apart.norm() + slid));
      return onThisSide(i) || apart.dot(from_middle) <= (1.0 + kRounding) * turn;
    };
    const Index hint = hintFor(p, tet, x, field, near.hint);
    found = tree_.shortlistOf(p, x, hint, motion_, onThisSide, mayBe, kListed * tissue_.short_edge,
                              near.list);
    remember(p, near);
    near.rest_point = rest_of;
    near.rest_place = place;
  }
  near.hint = found.triangle;
  return takeFeature(p, found, x, sample);
}

/** That the list was made now. */
void TissueDepth::remember(const Vec3& p, NearBoundary& near) const
{
  near.place = p - travel_.shift;
  near.travelled = travel_.most;
  near.travel = travel_.number;
}

std::optional<TetCoordinates> TissueDepth::coordinates(Index tet, const Points& x) const
{
  const Tet& nodes = (*tissue_.tets)[tet];
  return tetCoordinates(x[nodes[0]], x[nodes[1]], x[nodes[2]], x[nodes[3]]);
}

bool TissueDepth::interpolate(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                              ContactSample& sample) const
{
  const auto coords = coordinates(tet, x);
  if (!coords)
  {
    return false;
  }
  const Tet& nodes = (*tissue_.tets)[tet];
  const Eigen::Vector4d weights = coords->weights(p);
  Eigen::Vector4d depth;
  sample.count = 4;
  for (int k = 0; k < 4; ++k)
  {
    depth[k] = field.depth()[nodes[k]];
    sample.node[k] = tissue_.first_node + nodes[k];
    sample.coefficient[k] = -weights[k];
  }
  sample.depth = weights.dot(depth);
  sample.gradient = coords->gradients * depth;
  return true;
}

/** What is on a triangle of its own tet, as the ends of clipped edges are, needs no search. */
template <typename Allowed>
TriangleTree::Nearest TissueDepth::onOwnTriangle(const Vec3& p, Index tet, const Points& x,
                                                 const Allowed& allowed) const
{
  TriangleTree::Nearest found;
  for (const Index* own = tet_triangles_.begin(tet); own != tet_triangles_.end(tet); ++own)
  {
    const Triangle& t = tissue_.surface->triangles[*own];
    const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
    const double near = kOnSurface * (b - a).norm();
    const TrianglePoint point = closestOnTriangle(p, a, b, c);
    if (allowed(*own) && point.squared_distance <= near * near)
    {
      found.take(*own, point);
      break;
    }
  }
  return found;
}

/** The nearest one that is allowed, if what was listed before still tells. */
template <typename Allowed>
TriangleTree::Nearest TissueDepth::listed(const Vec3& p, const Points& x, const NearBoundary& near,
                                          const Allowed& allowed) const
{
  TriangleTree::Nearest found;
  if (near.travel != travel_.number)
  {
    return found;
  }
  const Shortlist& list = near.list;
  const double moved = (p - travel_.shift - near.place).norm() + (travel_.most - near.travelled);
  // Nearer than this nothing came of what then was at a distance.
  const auto least = [moved](double then) { return (1.0 - kRounding) * then - moved; };
  double distance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < list.size() && least(list.distance(i)) <= distance; ++i)
  {
    const Triangle& t = tissue_.surface->triangles[list[i]];
    if (allowed(list[i]))
    {
      found.take(list[i], closestOnTriangle(p, x[t[0]], x[t[1]], x[t[2]]));
      distance = std::sqrt(found.point.squared_distance);
    }
  }
  return distance < least(list.radius()) ? found : TriangleTree::Nearest();
}

Index TissueDepth::hintFor(const Vec3& p, Index tet, const Points& x, const DistanceField& field,
                           Index hint) const
{
  if (hint >= 0)
  {
    return hint;
  }
  if (tet_triangles_.begin(tet) != tet_triangles_.end(tet))
  {
    return *tet_triangles_.begin(tet);
  }
  const Tet& nodes = (*tissue_.tets)[tet];
  return field.closestTriangle()[nodes[nearestCorner(p, nodes, x)]];
}

/** @return false where nothing is finite */
bool TissueDepth::takeFeature(const Vec3& p, const TriangleTree::Nearest& found, const Points& x,
                              ContactSample& sample) const
{
  if (found.triangle < 0)
  {
    return false;
  }
  const Triangle& triangle = tissue_.surface->triangles[found.triangle];
  const double distance = std::sqrt(found.point.squared_distance);
  sample.count = 3;
  for (int k = 0; k < 3; ++k)
  {
    sample.node[k] = tissue_.first_node + triangle[k];
    sample.coefficient[k] = -found.point.weights[k];
  }
  sample.depth = distance;
  // There the direction is lost in rounding: it is the triangle's own normal.
  const Vec3 side = x[triangle[1]] - x[triangle[0]];
  sample.gradient = distance > kOnSurface * side.norm()
                        ? Vec3((p - found.point.point) / distance)
                        : Vec3((x[triangle[2]] - x[triangle[0]]).cross(side).normalized());
  return true;
}

}  // namespace soft_tissue
