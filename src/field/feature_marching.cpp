#include "feature_marching.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "soft_tissue_sim/geometry/closest_point.h"

namespace soft_tissue
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Index kAll = -1;
}  // namespace

double TriangleFeatures::squaredDistance(const BoundarySurface& surface, Index triangle,
                                         const Points& x, const Vec3& p)
{
  const Triangle& t = surface.triangles[triangle];
  return closestOnTriangle(p, x[t[0]], x[t[1]], x[t[2]]).squared_distance;
}

template <typename Feature>
FeatureMarching<Feature>::FeatureMarching(const FieldTopology& topology)
    : NodalField(topology), heap_(static_cast<Index>(nodeCount()))
{
  offers_.assign(nodeCount(), {kInfinity, -1});
  wanted_in_march_.assign(nodeCount(), 0);
  collectSeeds();
}

/** What the boundary nodes will offer depends on connectivity alone: each feature once a node. */
template <typename Feature>
void FeatureMarching<Feature>::collectSeeds()
{
  const BoundarySurface& surface = *topology_.surface;
  seeds_.offsets.push_back(0);
  for (Index node = 0; node < topology_.node_neighbours->size(); ++node)
  {
    if (surface.node_slot[node] >= 0)
    {
      continue;
    }
    const auto first = static_cast<std::ptrdiff_t>(seeds_.items.size());
    for (const Index* other = topology_.node_neighbours->begin(node);
         other != topology_.node_neighbours->end(node); ++other)
    {
      if (surface.node_slot[*other] >= 0)
      {
        seeds_.items.insert(seeds_.items.end(), Feature::begin(surface, *other),
                            Feature::end(surface, *other));
      }
    }
    std::sort(seeds_.items.begin() + first, seeds_.items.end());
    seeds_.items.erase(std::unique(seeds_.items.begin() + first, seeds_.items.end()),
                       seeds_.items.end());
    if (static_cast<std::ptrdiff_t>(seeds_.items.size()) > first)
    {
      seed_nodes_.push_back(node);
      seeds_.offsets.push_back(static_cast<Index>(seeds_.items.size()));
    }
  }
}

template <typename Feature>
void FeatureMarching<Feature>::march(const Points& x)
{
  begin(x);
  seed(x);
  run(x, kAll);
}

template <typename Feature>
void FeatureMarching<Feature>::marchUntil(const Points& x, const std::vector<Index>& wanted)
{
  begin(x);
  const Index missing = countMissing(wanted);
  if (missing > 0)
  {
    seed(x);
    run(x, missing);
  }
}

template <typename Feature>
void FeatureMarching<Feature>::begin(const Points& x)
{
  for (const Index node : touched_)
  {
    offers_[node] = {kInfinity, -1};
  }
  forgetMarch(x);
  heap_.clear();
}

/** Marks the wanted nodes and returns how many different ones have no depth yet. */
template <typename Feature>
Index FeatureMarching<Feature>::countMissing(const std::vector<Index>& wanted)
{
  checkWanted(wanted);
  ++march_number_;
  Index missing = 0;
  for (const Index node : wanted)
  {
    if (std::isnan(depth_[node]) && wanted_in_march_[node] != march_number_)
    {
      wanted_in_march_[node] = march_number_;
      ++missing;
    }
  }
  return missing;
}

/** All boundary nodes have depth 0 and come first: each offers all features on it. */
template <typename Feature>
void FeatureMarching<Feature>::seed(const Points& x)
{
  for (std::size_t i = 0; i < seed_nodes_.size(); ++i)
  {
    const Index row = static_cast<Index>(i);
    for (const Index* feature = seeds_.begin(row); feature != seeds_.end(row); ++feature)
    {
      offer(seed_nodes_[i], *feature, x);
    }
  }
}

template <typename Feature>
void FeatureMarching<Feature>::run(const Points& x, Index missing)
{
  while (!heap_.empty())
  {
    const Index node = heap_.pop();
    depth_[node] = std::sqrt(offers_[node].squared_distance);
    const Index feature = offers_[node].feature;
    closest_[node] = Feature::triangle(*topology_.surface, feature);
    if (missing != kAll && wanted_in_march_[node] == march_number_ && --missing == 0)
    {
      return;
    }
    for (const Index* other = topology_.node_neighbours->begin(node);
         other != topology_.node_neighbours->end(node); ++other)
    {
      if (std::isnan(depth_[*other]) && offers_[*other].feature != feature)
      {
        offer(*other, feature, x);
      }
    }
  }
}

template <typename Feature>
void FeatureMarching<Feature>::offer(Index node, Index feature, const Points& x)
{
  ++evaluations_;
  const double squared = Feature::squaredDistance(*topology_.surface, feature, x, x[node]);
  Offer& best = offers_[node];
  if (squared < best.squared_distance)
  {
    if (best.feature < 0)
    {
      touched_.push_back(node);
    }
    best = {squared, feature};
    heap_.pushOrDecrease(node, squared);
  }
  else if (squared == best.squared_distance && feature < best.feature)
  {
    best.feature = feature;
  }
}

template class FeatureMarching<TriangleFeatures>;
template class FeatureMarching<NodeFeatures>;

}  // namespace soft_tissue
