#include "closest_feature_marching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/geometry/closest_point.h"

namespace soft_tissue
{
namespace
{
constexpr double kNotMarched = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Index kAll = -1;

const FieldTopology& checked(const FieldTopology& topology)
{
  if (!topology.tets || !topology.surface || !topology.node_neighbours)
  {
    throw Error("distance field: tets, surface and node_neighbours must all be given");
  }
  const std::size_t node_count = topology.node_neighbours->size();
  if (topology.surface->node_slot.size() != node_count)
  {
    throw Error("distance field: the surface is of a mesh of " +
                std::to_string(topology.surface->node_slot.size()) +
                " nodes, node_neighbours of one of " + std::to_string(node_count));
  }
  return topology;
}
}  // namespace

ClosestFeatureMarching::ClosestFeatureMarching(const FieldTopology& topology)
    : topology_(checked(topology)), heap_(topology.node_neighbours->size())
{
  const std::size_t node_count = topology_.node_neighbours->size();
  depth_.assign(node_count, kNotMarched);
  closest_.assign(node_count, -1);
  offers_.assign(node_count, {kInfinity, -1});
  wanted_in_march_.assign(node_count, 0);
  touched_.reserve(node_count);
  for (const Index node : topology_.surface->nodes)
  {
    depth_[node] = 0.0;
    closest_[node] = *topology_.surface->node_triangles.begin(node);
  }
  collectSeeds();
}

/** What the boundary nodes will offer depends on connectivity alone: each triangle once a node. */
void ClosestFeatureMarching::collectSeeds()
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
      seeds_.items.insert(seeds_.items.end(), surface.node_triangles.begin(*other),
                          surface.node_triangles.end(*other));
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

void ClosestFeatureMarching::march(const Points& x)
{
  begin(x);
  seed(x);
  run(x, kAll);
}

void ClosestFeatureMarching::marchUntil(const Points& x, const std::vector<Index>& wanted)
{
  begin(x);
  const Index missing = countMissing(wanted);
  if (missing > 0)
  {
    seed(x);
    run(x, missing);
  }
}

void ClosestFeatureMarching::begin(const Points& x)
{
  if (x.size() != depth_.size())
  {
    throw Error("distance field: " + std::to_string(x.size()) + " positions for " +
                std::to_string(depth_.size()) + " nodes");
  }
  for (const Index node : touched_)
  {
    depth_[node] = kNotMarched;
    closest_[node] = -1;
    offers_[node] = {kInfinity, -1};
  }
  touched_.clear();
  heap_.clear();
}

/** Marks the wanted nodes and returns how many different ones have no depth yet. */
Index ClosestFeatureMarching::countMissing(const std::vector<Index>& wanted)
{
  for (const Index node : wanted)
  {
    if (node < 0 || node >= static_cast<Index>(depth_.size()))
    {
      throw Error("distance field: wanted node " + std::to_string(node) + ", must be in [0, " +
                  std::to_string(depth_.size()) + ")");
    }
  }
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

/** All boundary nodes have depth 0 and come first: each offers all triangles around it. */
void ClosestFeatureMarching::seed(const Points& x)
{
  for (std::size_t i = 0; i < seed_nodes_.size(); ++i)
  {
    const Index row = static_cast<Index>(i);
    for (const Index* triangle = seeds_.begin(row); triangle != seeds_.end(row); ++triangle)
    {
      offer(seed_nodes_[i], *triangle, x);
    }
  }
}

void ClosestFeatureMarching::run(const Points& x, Index missing)
{
  while (!heap_.empty())
  {
    const Index node = heap_.pop();
    depth_[node] = std::sqrt(offers_[node].squared_distance);
    closest_[node] = offers_[node].triangle;
    if (missing != kAll && wanted_in_march_[node] == march_number_ && --missing == 0)
    {
      return;
    }
    for (const Index* other = topology_.node_neighbours->begin(node);
         other != topology_.node_neighbours->end(node); ++other)
    {
      if (std::isnan(depth_[*other]) && offers_[*other].triangle != closest_[node])
      {
        offer(*other, closest_[node], x);
      }
    }
  }
}

void ClosestFeatureMarching::offer(Index node, Index triangle, const Points& x)
{
  const Triangle& t = topology_.surface->triangles[triangle];
  const double squared = closestOnTriangle(x[node], x[t[0]], x[t[1]], x[t[2]]).squared_distance;
  Offer& best = offers_[node];
  if (squared < best.squared_distance)
  {
    if (best.triangle < 0)
    {
      touched_.push_back(node);
    }
    best = {squared, triangle};
    heap_.pushOrDecrease(node, squared);
  }
  else if (squared == best.squared_distance && triangle < best.triangle)
  {
    best.triangle = triangle;
  }
}

}  // namespace soft_tissue
