#include "grid_marching.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
/** The least extent of a grid's axis, as a share of its longest: bodies may be flat. */
constexpr double kThinnest = 1e-3;
}  // namespace

GridMarching::GridMarching(const FieldTopology& topology, int points)
    : NodalField(topology), points_(points)
{
  if (points < FieldOptions::kLeastGridPoints)
  {
    throw Error("grid field: " + std::to_string(points) +
                " points along the longest side, must be " + "at least " +
                std::to_string(FieldOptions::kLeastGridPoints));
  }
  for (const Triangle& t : topology_.surface->triangles)
  {
    planar_ = planar_ && (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]);
  }
}

void GridMarching::march(const Points& x)
{
  forgetMarch(x);
  marchGrid(x);
  for (Index node = 0; node < static_cast<Index>(nodeCount()); ++node)
  {
    read(node, x);
  }
}

void GridMarching::marchUntil(const Points& x, const std::vector<Index>& wanted)
{
  checkWanted(wanted);
  forgetMarch(x);
  const bool any = std::any_of(wanted.begin(), wanted.end(),
                               [&](Index node) { return topology_.surface->node_slot[node] < 0; });
  if (any)
  {
    marchGrid(x);
  }
  for (const Index node : wanted)
  {
    read(node, x);
  }
}

void GridMarching::marchGrid(const Points& x)
{
  tree_fits_ = false;
  if (topology_.surface->triangles.empty())
  {
    return;
  }
  const GridSpec grid = placed(x);
  if (grid_)
  {
    grid_->place(grid);
  }
  else
  {
    grid_.emplace(grid, GridOrder::second);
    built_at_ = x;
  }
  const std::uint64_t before = grid_->evaluations();
  grid_->march(*topology_.surface, x);
  evaluations_ += grid_->evaluations() - before;
}

/** The grid around the surface as it is now. */
GridSpec GridMarching::placed(const Points& x) const
{
  Box3 box;
  for (const Index node : topology_.surface->nodes)
  {
    if (x[node].allFinite())
    {
      box.extend(x[node]);
    }
  }
  Vec3 extent = box.max - box.min;
  const double longest = extent.maxCoeff();
  if (!(longest > 0.0) || !std::isfinite(longest))
  {
    box = {Vec3::Zero(), Vec3::Ones()};  // a point, or nothing: any grid does
    extent = box.max;
  }
  for (int axis = 0; axis < (planar_ ? 2 : 3); ++axis)
  {
    const double missing = kThinnest * extent.maxCoeff() - extent[axis];
    box.min[axis] -= std::max(0.0, 0.5 * missing);
    box.max[axis] += std::max(0.0, 0.5 * missing);
  }
  if (grid_)
  {
    return GridSpec::around(box, grid_->grid().count);
  }
  std::array<int, 3> count = {points_, points_, 1};
  for (int axis = 0; axis < (planar_ ? 2 : 3); ++axis)
  {
    const double share = (box.max[axis] - box.min[axis]) / extent.maxCoeff();
    count[axis] = std::max(FieldOptions::kLeastGridPoints,
                           static_cast<int>(std::lround(share * (points_ - 5))) + 5);
  }
  return GridSpec::around(box, count);
}

void GridMarching::fitTree(const Points& x)
{
  if (tree_.empty())
  {
    // To build it needs finite triangles, not to search them.
    tree_.build(topology_.surface->triangles, finiteOf(x));
    tree_built_at_ = x;
  }
  if (!tree_fits_)
  {
    tree_.refit(x);
    tree_fits_ = true;
  }
}

// Every march begins with the whole grid: only its size, and the tree's shape, stay.
void GridMarching::exchange(StateArchive& archive)
{
  archive.list(built_at_);
  archive.list(tree_built_at_);
  if (archive.reading())
  {
    grid_.reset();
    tree_ = TriangleTree();
    tree_fits_ = false;
    if (!built_at_.empty())
    {
      grid_.emplace(placed(built_at_), GridOrder::second);
    }
    if (!tree_built_at_.empty())
    {
      tree_.build(topology_.surface->triangles, finiteOf(tree_built_at_));
    }
  }
  NodalField::exchange(archive);
}

void GridMarching::read(Index node, const Points& x)
{
  const bool inside =
      topology_.surface->node_slot[node] < 0 &&
      topology_.node_neighbours->begin(node) != topology_.node_neighbours->end(node);
  if (!inside || !grid_ || !x[node].allFinite())
  {
    return;
  }
  double depth = grid_->extrapolate(x[node]);
  if (!(depth > 0.0))
  {
    fitTree(x);
    const TriangleTree::Nearest nearest = tree_.nearest(x[node], x);
    evaluations_ += nearest.evaluations;
    if (nearest.triangle < 0)
    {
      return;
    }
    depth = std::sqrt(nearest.point.squared_distance);
  }
  depth_[node] = depth;
  touched_.push_back(node);
}

}  // namespace soft_tissue
