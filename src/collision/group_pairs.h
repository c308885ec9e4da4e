#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "element_groups.h"
#include "kept_pairs.h"
#include "pair_order.h"

namespace soft_tissue
{
/**
 * What the ways to find pairs have in common; they differ in how they get from sets to groups.
 *
 * Where elements come nearer slowly, a search goes farther than asked, and later calls pick from
 * its pairs until elements may have come nearer than it went.
 */
class GroupPairs : public PairFinder
{
 public:
  GroupPairs(const ElementSet& first, const ElementSet& second, bool one_body);

  void find(const Vec3* x_first, const Vec3* x_second, double margin,
            std::vector<ElementPair>& pairs) override;
  void leaveOut(std::function<bool(const ElementPair&)> never) override
  {
    never_ = std::move(never);
  }

 protected:
  /** Adds the pairs of this call, in any order; the bounds of both sets overlap. */
  virtual void search() = 0;

  /** Adds the pairs between two groups. */
  void join(Index first_group, Index second_group);

  /** Adds a pair whose boxes overlap, by its places in the groups, unless it is no pair. */
  void add(Index first_place, Index second_place)
  {
    if (!one_body_ || !shareNode(first_place, second_place))
    {
      if (found_.size() == found_count_)
      {
        found_.resize(2 * found_count_ + 1);
      }
      found_[found_count_++] = {first_.element(first_place), second_.element(second_place)};
    }
  }

  ElementGroups first_, second_;
  BoxEnds slack_;  ///< how far boxes of both trees may seem apart that do overlap

 private:
  bool shareNode(Index first_place, Index second_place) const
  {
    using FourNodes = Index __attribute__((vector_size(16)));
    FourNodes nodes;
    std::memcpy(&nodes, second_.nodes(second_place).data(), sizeof(nodes));
    FourNodes shared = {};
    for (int k = 0; k < first_.nodesEach(); ++k)
    {
      shared |= nodes == first_.nodes(first_place)[k];
    }
    std::int64_t halves[2];
    std::memcpy(halves, &shared, sizeof(halves));
    return (halves[0] | halves[1]) != 0;
  }

  double nearerSinceRefit() const;
  double lookAhead(double nearer_a_call) const;
  void searchAll(std::vector<ElementPair>& pairs);
  void setLaneScale();

  bool one_body_;
  std::function<bool(const ElementPair&)> never_;  ///< none: all are pairs
  std::vector<ElementPair> found_;                 ///< longer than they are many
  std::size_t found_count_ = 0;
  PairOrder order_;
  KeptPairs kept_;
  double reach_ = -1.0;  ///< margin of the search whose pairs are kept, m; below 0: none are
  int calls_ = 0;        ///< since both trees were made to fit
};

}  // namespace soft_tissue
