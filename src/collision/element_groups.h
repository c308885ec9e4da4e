#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "box_lanes.h"
#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
/**
 * Elements of a set in groups of those near each other, and a binary tree of boxes over the groups.
 *
 * The tree's boxes are old: those of the last refit. How far nodes moved since then, along each
 * axis at least and at most, is found anew in each call and added when boxes are compared: a body
 * that is only shifted never needs a refit. The boxes of a group's elements are made when asked
 * for.
 */
class ElementGroups
{
 public:
  static constexpr Index kSize = BoxLanes::kCount;  ///< elements of a group

  enum class Role
  {
    first,
    second
  };

  ElementGroups(const ElementSet& set, Role role);

  /** Looks where the nodes are; x must stay until the next call. m */
  void place(const Vec3* x, double margin);

  /** Box around all finite nodes, with the margin. */
  const BoxEnds& bounds() const { return bounds_; }

  /** Makes the tree's boxes fit well enough to be gone through; the groups at the first call. */
  void refitIfNeeded();
  /** Makes them fit as they were just placed. */
  void refit();
  std::uint32_t refits() const { return refits_; }

  bool allFinite() const { return all_finite_; }
  /** What rounding may add to a distance, m. */
  double rounding() const;
  /** How wide drift may get before boxes are made anew, m; below 0 at first. */
  double slack() const { return slack_; }
  /** Grows the margin of this call, m. */
  void widen(double by);

  /** Counts the margin and rounding as drift; before the tree is gone through. */
  void addMarginToDrift();
  /** How far the true ends of a box may lie below those of the tree. */
  const BoxEnds& drift() const { return drift_; }

  int levels() const { return static_cast<int>(levels_.size()); }
  /** Boxes of a level, the groups' own at 0; box i holds boxes 2 i and 2 i + 1 of the level below.
   */
  const std::vector<BoxEnds>& level(int number) const { return levels_[number]; }

  /** How the lanes of this call are made; before the first group is opened. */
  void setLaneScale(const BoxEnds& middle, const BoxEnds& per_metre)
  {
    scale_ = {middle, per_metre};
  }

  /** Makes the boxes of a group's elements, once a call. */
  void open(Index group)
  {
    if (opened_[group] != call_)
    {
      makeBoxes(group);
    }
  }
  /** Of an opened group. */
  const BoxEnds& groupBox(Index group) const { return group_boxes_[group]; }
  /** Of an element by its place in the groups, which must be open. */
  const BoxEnds& box(Index place) const { return boxes_[place]; }

  /** Of an opened group's elements, and of itself. */
  const BoxLanes& lanes(Index group) const { return lanes_[group]; }
  const LaneBox& groupLane(Index group) const { return group_lanes_[group]; }

  Index begin(Index group) const { return group * kSize; }
  Index end(Index group) const { return std::min(set_.count, (group + 1) * kSize); }
  Index element(Index place) const { return order_[place]; }
  /** The nodes of an element by its place; the last one again where there are fewer than four. */
  const std::array<Index, 4>& nodes(Index place) const { return nodes_[place]; }
  int nodesEach() const { return set_.nodes_each; }

 private:
  BoxEnds endsOf(const Vec3& low, const Vec3& high) const;
  BoxEnds elementBox(Index place) const;
  void placeFiniteNodes();
  void makeGroups();
  void nameNodes();
  void arrange(const std::vector<Vec3>& centres, Index* begin, Index* end);
  void makeBoxes(Index group);
  void fitBoxes();

  ElementSet set_;
  double sign_;                    ///< of the first three ends
  std::vector<Index> used_nodes_;  ///< ascending
  const Vec3* x_ = nullptr;        ///< this call's positions
  double margin_ = 0.0;            ///< of this call
  bool all_finite_ = true;         ///< in this call
  bool all_finite_at_refit_ = true;
  BoxEnds bounds_, drift_;
  double slack_ = -1.0;                        ///< m, growth of boxes by drift that is put up with
  std::vector<Vec3> x_at_refit_;               ///< of the used nodes, m
  double size_ = 0.0, size_when_made_ = -1.0;  ///< edges of all groups' boxes, m
  double largest_at_refit_ = 0.0;              ///< coordinate, m
  std::vector<Index> order_;                   ///< elements, group after group
  std::vector<std::array<Index, 4>> nodes_;    ///< theirs
  std::vector<Index> group_nodes_, group_node_offsets_;  ///< each node of a group once
  std::vector<std::vector<BoxEnds>> levels_;
  std::vector<BoxEnds> boxes_, group_boxes_;
  std::vector<BoxLanes> lanes_;
  std::vector<LaneBox> group_lanes_;
  LaneScale scale_ = {};
  std::vector<std::uint32_t> opened_;  ///< the call that a group was opened in
  std::uint32_t call_ = 0, refits_ = 0;
};

}  // namespace soft_tissue
