#include "exact_marching.h"

#include <cmath>
#include <limits>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/geometry/morton_order.h"

namespace soft_tissue
{
namespace
{
constexpr Index kGrain = 1024;
}  // namespace

ExactMarching::ExactMarching(const FieldTopology& topology) : NodalField(topology)
{
  hint_.assign(nodeCount(), -1);
  rank_.assign(nodeCount(), -1);
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
  checkWanted(wanted);
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
  forgetMarch(x);
  if (tree_.empty() && !topology_.surface->triangles.empty())
  {
    tree_.build(topology_.surface->triangles, x);
    makeOrder(x);
    built_at_ = x;
  }
  else
  {
    tree_.refit(x);
  }
}

// Of triangles equally near the tree and the hint decide.
void ExactMarching::exchange(StateArchive& archive)
{
  archive.list(built_at_);
  if (archive.reading())
  {
    tree_ = TriangleTree();
    order_.clear();
    rank_.assign(nodeCount(), -1);
    if (!built_at_.empty())
    {
      begin(Points(built_at_));
    }
  }
  archive.values(hint_);
  NodalField::exchange(archive);
}

void ExactMarching::makeOrder(const Points& x)
{
  for (const Index node : mortonOrder(finiteOf(x)))
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
