#include "exact_marching.h"

#include <cmath>
#include <limits>

#include "field_checks.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/geometry/morton_order.h"

namespace soft_tissue
{
namespace
{
constexpr double kNotMarched = std::numeric_limits<double>::quiet_NaN();
constexpr Index kGrain = 1024;
}  // namespace

ExactMarching::ExactMarching(const FieldTopology& topology) : topology_(checked(topology))
{
  const std::size_t node_count = topology_.node_neighbours->size();
  depth_.assign(node_count, kNotMarched);
  closest_.assign(node_count, -1);
  hint_.assign(node_count, -1);
  rank_.assign(node_count, -1);
  touched_.reserve(node_count);
  for (const Index node : topology_.surface->nodes)
  {
    depth_[node] = 0.0;
    closest_[node] = *topology_.surface->node_triangles.begin(node);
  }
}

void ExactMarching::march(const Points& x)
{
  begin(x);
  evaluations_ += parallelSum(static_cast<Index>(order_.size()), kGrain,
                              [&](Index chunk_begin, Index chunk_end) {
                                std::uint64_t evaluations = 0;
                                for (Index i = chunk_begin; i < chunk_end; ++i)
                                {
                                  evaluations += visit(order_[i], chunk_begin, x);
                                }
                                return evaluations;
                              });
  touched_ = order_;
}

void ExactMarching::marchUntil(const Points& x, const std::vector<Index>& wanted)
{
  checkWanted(wanted, x.size());
  begin(x);
  for (const Index node : wanted)
  {
    if (std::isnan(depth_[node]) && rank_[node] >= 0)
    {
      evaluations_ += visit(node, std::numeric_limits<Index>::max(), x);
      touched_.push_back(node);
    }
  }
}

/** Forgets the last march and takes the surface as it is now. */
void ExactMarching::begin(const Points& x)
{
  checkPositions(x, depth_.size());
  for (const Index node : touched_)
  {
    depth_[node] = kNotMarched;
    closest_[node] = -1;
  }
  touched_.clear();
  if (tree_.empty() && !topology_.surface->triangles.empty())
  {
    tree_.build(topology_.surface->triangles, x);
    makeOrder(x);
  }
  else
  {
    tree_.refit(x);
  }
}

void ExactMarching::makeOrder(const Points& x)
{
  Points finite = x;
  for (Vec3& p : finite)
  {
    p = p.allFinite() ? p : Vec3(Vec3::Zero());
  }
  for (const Index node : mortonOrder(finite))
  {
    // A node in no tet is neither inside nor on the boundary.
    if (topology_.surface->node_slot[node] < 0 &&
        topology_.node_neighbours->begin(node) != topology_.node_neighbours->end(node))
    {
      rank_[node] = static_cast<Index>(order_.size());
      order_.push_back(node);
    }
  }
}

/** Finds a node's triangle from a hint: its last one, or that of a neighbour on the boundary or
 * from chunk_begin to here. @return triangles looked at closely */
int ExactMarching::visit(Index node, Index chunk_begin, const Points& x)
{
  Index hint = hint_[node];
  const Index rank = rank_[node];
  for (const Index* other = topology_.node_neighbours->begin(node);
       hint < 0 && other != topology_.node_neighbours->end(node); ++other)
  {
    const bool known = rank_[*other] < 0 || (rank_[*other] >= chunk_begin && rank_[*other] < rank);
    hint = known ? closest_[*other] : -1;
  }
  const TriangleTree::Nearest found = tree_.nearest(x[node], x, hint);
  if (found.triangle >= 0)
  {
    depth_[node] = std::sqrt(found.point.squared_distance);
    closest_[node] = hint_[node] = found.triangle;
  }
  return found.evaluations;
}

}  // namespace soft_tissue
