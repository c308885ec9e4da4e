#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "soft_tissue_sim/collision/pair_finder.h"

namespace soft_tissue
{
/**
 * The ends of a box as pairs are looked for: (min, -max) of a box of the first set, (-max, min) of
 * one of the second. The box around several is the least of each number, and two boxes of different
 * sets overlap where no sum of their numbers is above zero. A box of nothing is +infinity.
 */
struct BoxEnds
{
  double v[6];
};

using TwoDoubles = double __attribute__((vector_size(16)));
using TwoMasks = std::int64_t __attribute__((vector_size(16)));

inline TwoDoubles two(const BoxEnds& ends, int k)
{
  TwoDoubles values;
  std::memcpy(&values, ends.v + 2 * k, sizeof(values));
  return values;
}

/** Whether boxes of two sets overlap when each end may be off by the slack. */
inline bool overlap(const BoxEnds& first, const BoxEnds& second, const BoxEnds& slack)
{
  const TwoMasks apart = (two(first, 0) + two(second, 0) > two(slack, 0)) |
                         (two(first, 1) + two(second, 1) > two(slack, 1)) |
                         (two(first, 2) + two(second, 2) > two(slack, 2));
  return (apart[0] | apart[1]) == 0;
}

inline bool overlap(const BoxEnds& first, const BoxEnds& second)
{
  return overlap(first, second, BoxEnds{});
}

BoxEnds noBox();
void extend(BoxEnds& ends, const BoxEnds& other);

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
  static constexpr Index kSize = 16;  ///< elements of a group

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
  std::uint32_t refits() const { return refits_; }

  /** How far the true ends of a box may lie below those of the tree. */
  const BoxEnds& drift() const { return drift_; }

  int levels() const { return static_cast<int>(levels_.size()); }
  /** Boxes of a level, the groups' own at 0; box i holds boxes 2 i and 2 i + 1 of the level below.
   */
  const std::vector<BoxEnds>& level(int number) const { return levels_[number]; }

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

  Index begin(Index group) const { return group * kSize; }
  Index end(Index group) const { return std::min(set_.count, (group + 1) * kSize); }
  Index element(Index place) const { return order_[place]; }
  /** The nodes of an element by its place; the last one again where there are fewer than four. */
  const std::array<Index, 4>& nodes(Index place) const { return nodes_[place]; }

 private:
  BoxEnds endsOf(const Vec3& low, const Vec3& high) const;
  BoxEnds elementBox(Index place) const;
  void placeFiniteNodes();
  void makeGroups();
  void nameNodes();
  void arrange(const std::vector<Vec3>& centres, Index* begin, Index* end);
  void makeBoxes(Index group);
  void refit();

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
  std::vector<std::uint32_t> opened_;  ///< the call that a group was opened in
  std::uint32_t call_ = 0, refits_ = 0;
};

}  // namespace soft_tissue
