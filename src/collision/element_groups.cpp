#include "element_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "box_kernels.h"

namespace soft_tissue
{
namespace
{
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/** Boxes grown by this share of a group's mean edge cost less than a refit does. */
constexpr double kSlack = 0.25;
/** Groups that have grown by this much are made anew: their elements are no longer near. */
constexpr double kGrown = 3.0;
/** Several times what rounding does to sums of a few coordinates. */
constexpr double kRounding = 1e-14;
}  // namespace

ElementGroups::ElementGroups(const ElementSet& set, Role role)
    : set_(set),
      sign_(role == Role::first ? 1.0 : -1.0),
      used_nodes_(set.nodes, set.nodes + static_cast<std::size_t>(set.count) * set.nodes_each),
      bounds_(noBox()),
      drift_()
{
  std::sort(used_nodes_.begin(), used_nodes_.end());
  used_nodes_.erase(std::unique(used_nodes_.begin(), used_nodes_.end()), used_nodes_.end());
}

BoxEnds ElementGroups::endsOf(const Vec3& low, const Vec3& high) const
{
  return sign_ > 0.0 ? BoxEnds{{low[0], low[1], low[2], -high[0], -high[1], -high[2]}}
                     : BoxEnds{{-high[0], -high[1], -high[2], low[0], low[1], low[2]}};
}

void ElementGroups::place(const Vec3* x, double margin)
{
  x_ = x;
  margin_ = margin;
  ++call_;
  const NodeExtremes now =
      boxKernels(instructionSet())
          .extremes(x, used_nodes_.data(), x_at_refit_.empty() ? nullptr : x_at_refit_.data(),
                    static_cast<Index>(used_nodes_.size()));
  all_finite_ = now.finite;
  if (!all_finite_)
  {
    placeFiniteNodes();
    return;
  }
  bounds_ = endsOf(now.low, now.high);
  for (double& end : bounds_.v)
  {
    end -= margin;
  }
  drift_ = endsOf(now.least_move, now.most_move);
}

// What is no number would spoil least and greatest values.
void ElementGroups::placeFiniteNodes()
{
  bounds_ = noBox();
  for (const Index node : used_nodes_)
  {
    if (x_[node].allFinite())
    {
      extend(bounds_, endsOf(x_[node], x_[node]));
    }
  }
  for (double& end : bounds_.v)
  {
    end -= margin_;
  }
}

void ElementGroups::refitIfNeeded()
{
  double growth = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    growth = std::max(growth, -(drift_.v[axis] + drift_.v[axis + 3]));
  }
  if (!all_finite_ || !all_finite_at_refit_ || !(growth <= slack_))
  {
    refit();
  }
}

void ElementGroups::refit()
{
  if (order_.empty())
  {
    makeGroups();
  }
  fitBoxes();
  if (!(size_ <= kGrown * size_when_made_))
  {
    makeGroups();
    fitBoxes();
    size_when_made_ = size_;
  }
  drift_ = {};
}

void ElementGroups::widen(double by)
{
  margin_ += by;
  for (double& end : bounds_.v)
  {
    end -= by;
  }
}

double ElementGroups::rounding() const
{
  double largest = largest_at_refit_ + margin_;
  for (const double end : bounds_.v)
  {
    largest = std::max(largest, std::abs(end));
  }
  return kRounding * largest;
}

void ElementGroups::addMarginToDrift()
{
  const double by = margin_ + rounding();
  for (double& end : drift_.v)
  {
    end -= by;
  }
}

BoxEnds ElementGroups::elementBox(Index place) const
{
  const std::array<Index, 4>& nodes = nodes_[place];
  Vec3 low = x_[nodes[0]], high = low;
  bool finite = all_finite_ || low.allFinite();
  for (int k = 1; k < set_.nodes_each; ++k)
  {
    const Vec3& p = x_[nodes[k]];
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
    finite = finite && (all_finite_ || p.allFinite());
  }
  return finite ? endsOf(low, high) : noBox();
}

void ElementGroups::makeGroups()
{
  const Index groups = (set_.count + kSize - 1) / kSize;
  order_.resize(set_.count);
  std::iota(order_.begin(), order_.end(), 0);
  nameNodes();
  std::vector<Vec3> centres;  // doubled
  for (Index i = 0; i < set_.count; ++i)
  {
    const BoxEnds ends = elementBox(i);
    const Vec3 centre(ends.v[0] - ends.v[3], ends.v[1] - ends.v[4], ends.v[2] - ends.v[5]);
    centres.push_back(centre.allFinite() ? centre : Vec3::Zero());
  }
  arrange(centres, order_.data(), order_.data() + set_.count);
  nameNodes();
  group_nodes_.clear();
  group_node_offsets_.assign(1, 0);
  for (Index group = 0; group < groups; ++group)
  {
    std::vector<Index> own;
    for (Index place = begin(group); place < end(group); ++place)
    {
      own.insert(own.end(), nodes_[place].begin(), nodes_[place].end());
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    group_nodes_.insert(group_nodes_.end(), own.begin(), own.end());
    group_node_offsets_.push_back(static_cast<Index>(group_nodes_.size()));
  }
  levels_.clear();
  levels_.emplace_back(groups);
  while (levels_.back().size() > 1)
  {
    levels_.emplace_back((levels_.back().size() + 1) / 2);
  }
  boxes_.resize(set_.count);
  group_boxes_.resize(groups);
  lanes_.resize(groups);
  group_lanes_.resize(groups);
  opened_.assign(groups, 0);
  x_at_refit_.resize(used_nodes_.size());
}

void ElementGroups::nameNodes()
{
  nodes_.resize(set_.count);
  for (Index place = 0; place < set_.count; ++place)
  {
    const Index* const nodes = set_.nodes + order_[place] * set_.nodes_each;
    for (int k = 0; k < 4; ++k)
    {
      nodes_[place][k] = nodes[std::min(k, set_.nodes_each - 1)];
    }
  }
}

// Halves the elements where the tree does: each left part fills all the groups it can have.
void ElementGroups::arrange(const std::vector<Vec3>& centres, Index* begin, Index* end)
{
  const std::ptrdiff_t count = end - begin;
  if (count <= kSize)
  {
    return;
  }
  std::ptrdiff_t half = kSize;
  while (2 * half < count)
  {
    half *= 2;
  }
  Vec3 low = centres[*begin], high = low;
  for (const Index* item = begin; item != end; ++item)
  {
    low = low.cwiseMin(centres[*item]);
    high = high.cwiseMax(centres[*item]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::nth_element(begin, begin + half, end, [&](Index left, Index right) {
    return centres[left][axis] != centres[right][axis] ? centres[left][axis] < centres[right][axis]
                                                       : left < right;
  });
  arrange(centres, begin, begin + half);
  arrange(centres, begin + half, end);
}

void ElementGroups::fitBoxes()
{
  ++refits_;
  std::vector<BoxEnds>& groups = levels_[0];
  size_ = 0.0;
  for (std::size_t group = 0; group < groups.size(); ++group)
  {
    Vec3 low = Vec3::Constant(kInfinity), high = -low;
    for (Index i = group_node_offsets_[group]; i < group_node_offsets_[group + 1]; ++i)
    {
      const Vec3& p = x_[group_nodes_[i]];
      if (all_finite_ || p.allFinite())
      {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    }
    groups[group] = endsOf(low, high);
    size_ += edges(groups[group]);
  }
  for (int k = 1; k < levels(); ++k)
  {
    const std::vector<BoxEnds>& below = levels_[k - 1];
    for (std::size_t i = 0; i < levels_[k].size(); ++i)
    {
      BoxEnds ends = below[2 * i];
      if (2 * i + 1 < below.size())
      {
        extend(ends, below[2 * i + 1]);
      }
      levels_[k][i] = ends;
    }
  }
  for (std::size_t i = 0; i < used_nodes_.size(); ++i)
  {
    x_at_refit_[i] = x_[used_nodes_[i]];
  }
  all_finite_at_refit_ = all_finite_;
  slack_ = kSlack * size_ / (3.0 * static_cast<double>(groups.size()));
  largest_at_refit_ = 0.0;
  for (const double end : bounds_.v)
  {
    largest_at_refit_ = std::max(largest_at_refit_, std::abs(end));
  }
}

void ElementGroups::makeBoxes(Index group)
{
  opened_[group] = call_;
  BoxEnds all = noBox();
  BoxLanes& lanes = lanes_[group];
  for (int i = 0; i < kSize; ++i)
  {
    LaneBox lane;
    lane.fill(BoxLanes::kNothing);
    const Index place = begin(group) + i;
    if (place < set_.count)
    {
      BoxEnds ends = elementBox(place);
      for (double& v : ends.v)
      {
        v -= margin_;
      }
      extend(all, ends);
      boxes_[place] = ends;
      lane = scale_(ends);
    }
    for (int k = 0; k < 6; ++k)
    {
      lanes.v[k][i] = lane[k];
    }
  }
  group_boxes_[group] = all;
  group_lanes_[group] = scale_(all);
}

}  // namespace soft_tissue
