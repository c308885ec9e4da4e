#include "soft_tissue_sim/geometry/triangle_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "soft_tissue_sim/base/error.h"

namespace soft_tissue
{
namespace
{
constexpr Index kWidth = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/** Rounding of normal . p - offset, as a share of the largest coordinate. */
constexpr double kPlaneRounding = 1e-14;
/** Below this squared sine of a corner a triangle is a needle. */
constexpr double kNeedle = 1e-12;
/** Patches of more triangles have no planes of their own: they are seldom flat. */
constexpr Index kLargestPatch = 256;

void clear(TriangleTreeNode& node)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    std::fill_n(node.min[axis], kWidth, kInfinity);
    std::fill_n(node.max[axis], kWidth, -kInfinity);
    std::fill_n(node.normal[axis], kWidth, 0.0);
  }
  std::fill_n(node.low, kWidth, 0.0);
  std::fill_n(node.high, kWidth, 0.0);
}

void place(TriangleTreeNode& node, int k, const Vec3& low, const Vec3& high, const Vec3& normal)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    node.min[axis][k] = low[axis];
    node.max[axis][k] = high[axis];
    node.normal[axis][k] = normal[axis];
  }
}

/** Splits [begin, end) across the longest side of its centres; the left part gets `left` items. */
void split(const std::vector<Vec3>& centres, Index* begin, Index* end, std::ptrdiff_t left)
{
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  for (const Index* item = begin; item != end; ++item)
  {
    low = low.cwiseMin(centres[*item]);
    high = high.cwiseMax(centres[*item]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::nth_element(begin, begin + left, end, [&](Index a, Index b) {
    return centres[a][axis] != centres[b][axis] ? centres[a][axis] < centres[b][axis] : a < b;
  });
}
}  // namespace

void TriangleTree::build(const std::vector<Triangle>& triangles, const Points& x)
{
  triangles_ = &triangles;
  search_ = searchTriangleTree(instructionSet());
  nodes_.clear();
  std::vector<Vec3> centres;
  centres.reserve(triangles.size());
  for (const Triangle& t : triangles)
  {
    centres.push_back((x[t[0]] + x[t[1]] + x[t[2]]) / 3.0);
    if (!centres.back().allFinite())
    {
      throw Error("triangle tree: triangle " + std::to_string(centres.size() - 1) +
                  " has a coordinate that is not finite");
    }
  }
  order_.resize(triangles.size());
  std::iota(order_.begin(), order_.end(), 0);
  normals_.assign(triangles.size(), Vec3::Zero());
  ranges_.clear();
  if (!order_.empty())
  {
    buildNode(centres, order_.data(), order_.data() + order_.size());
    refit(x);
  }
}

/** @return the node over these triangles, a part of order_ */
Index TriangleTree::buildNode(const std::vector<Vec3>& centres, Index* begin, Index* end)
{
  const Index self = static_cast<Index>(nodes_.size());
  nodes_.push_back({});
  ranges_.push_back(
      {static_cast<Index>(begin - order_.data()), static_cast<Index>(end - order_.data())});
  const std::ptrdiff_t count = end - begin;
  nodes_[self].leaf = count <= kWidth;
  std::fill_n(nodes_[self].child, kWidth, -1);
  if (nodes_[self].leaf)
  {
    std::copy(begin, end, nodes_[self].child);
    return self;
  }
  const auto filled = [&](std::ptrdiff_t items, std::ptrdiff_t parts) {
    // About half of the parts' items, in whole leaves.
    const std::ptrdiff_t half = items * (parts / 2) / parts;
    const std::ptrdiff_t whole = (half + kWidth - 1) / kWidth * kWidth;
    return std::min(whole, items);
  };
  const std::ptrdiff_t middle = filled(count, 4);
  split(centres, begin, end, middle);
  Index* const bounds[3] = {begin, begin + middle, end};
  int child = 0;
  for (int side = 0; side < 2; ++side)
  {
    const std::ptrdiff_t items = bounds[side + 1] - bounds[side];
    const std::ptrdiff_t left = items > kWidth ? filled(items, 2) : items;
    if (left < items)
    {
      split(centres, bounds[side], bounds[side + 1], left);
    }
    Index* const ends[3] = {bounds[side], bounds[side] + left, bounds[side + 1]};
    for (int part = 0; part < 2; ++part)
    {
      if (ends[part] != ends[part + 1])
      {
        const Index node = buildNode(centres, ends[part], ends[part + 1]);
        nodes_[self].child[child++] = node;
      }
    }
  }
  return self;
}

void TriangleTree::refit(const Points& x)
{
  for (std::size_t i = nodes_.size(); i-- > 0;)
  {
    TriangleTreeNode& node = nodes_[i];
    clear(node);
    for (int k = 0; k < kWidth && node.child[k] >= 0; ++k)
    {
      if (node.leaf)
      {
        const Index place = ranges_[i].begin + k;
        normals_[place] = renewTriangle(node, k, x);
      }
      else
      {
        renewChild(node, k, x);
      }
    }
  }
  const Box3 bounds = this->bounds();
  slack_ = kPlaneRounding * bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).maxCoeff();
}

/** @return the unit normal; zero for a needle, whose plane is lost in rounding */
Vec3 TriangleTree::renewTriangle(TriangleTreeNode& node, int k, const Points& x) const
{
  const Triangle& t = (*triangles_)[node.child[k]];
  const Vec3 &a = x[t[0]], &b = x[t[1]], &c = x[t[2]];
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 cross = ab.cross(ac);
  const double squared = cross.squaredNorm();
  const bool flat = !(squared > kNeedle * ab.squaredNorm() * ac.squaredNorm());
  const Vec3 normal = flat ? Vec3(Vec3::Zero()) : Vec3(cross / std::sqrt(squared));
  place(node, k, a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), normal);
  // A sliver's normal is inexact: its corners need not be at one height.
  const Vec3 heights(normal.dot(a), normal.dot(b), normal.dot(c));
  node.low[k] = heights.minCoeff();
  node.high[k] = heights.maxCoeff();
  return normal;
}

void TriangleTree::renewChild(TriangleTreeNode& node, int k, const Points& x) const
{
  const TriangleTreeNode& child = nodes_[node.child[k]];
  Vec3 low, high;
  for (int axis = 0; axis < 3; ++axis)
  {
    low[axis] = *std::min_element(child.min[axis], child.min[axis] + kWidth);
    high[axis] = *std::max_element(child.max[axis], child.max[axis] + kWidth);
  }
  const Range range = ranges_[node.child[k]];
  Vec3 normal = Vec3::Zero();
  if (range.end - range.begin <= kLargestPatch)
  {
    for (Index i = range.begin; i < range.end; ++i)
    {
      normal += normals_[i];
    }
    const double length = normal.norm();
    normal = length > 0.5 * (range.end - range.begin) ? Vec3(normal / length) : Vec3(Vec3::Zero());
  }
  place(node, k, low, high, normal);
  if (normal == Vec3::Zero())
  {
    return;
  }
  node.low[k] = kInfinity;
  node.high[k] = -kInfinity;
  for (Index i = range.begin; i < range.end; ++i)
  {
    for (const Index corner : (*triangles_)[order_[i]])
    {
      const double height = normal.dot(x[corner]);
      node.low[k] = std::min(node.low[k], height);
      node.high[k] = std::max(node.high[k], height);
    }
  }
}

Box3 TriangleTree::bounds() const
{
  Box3 box;
  for (int k = 0; k < kWidth && !nodes_.empty() && nodes_[0].child[k] >= 0; ++k)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      box.min[axis] = std::min(box.min[axis], nodes_[0].min[axis][k]);
      box.max[axis] = std::max(box.max[axis], nodes_[0].max[axis][k]);
    }
  }
  return box;
}

void TriangleTree::search(const Vec3& p, double bound, VisitTriangle visit, void* context) const
{
  if (!nodes_.empty() && p.allFinite())
  {
    search_(nodes_.data(), p.data(), slack_ + kPlaneRounding * p.cwiseAbs().maxCoeff(), bound,
            visit, context);
  }
}

}  // namespace soft_tissue
