#include <algorithm>
#include <numeric>

#include "group_pairs.h"
#include "pair_methods.h"

namespace soft_tissue
{
namespace
{
/** A group and where its box begins and ends along the axis that is swept. */
struct Stretch
{
  double begin, end;
  Index group;
};

/** The groups of a set in the order in which they begin. */
class SweepOrder
{
 public:
  void sort(const ElementGroups& groups, int axis, bool first)
  {
    if (refits_ == groups.refits() && !stretches_.empty())
    {
      return;  // all boxes of the tree are shifted by the same
    }
    refits_ = groups.refits();
    const std::vector<BoxEnds>& boxes = groups.level(0);
    const bool anew = stretches_.empty();
    if (anew)
    {
      stretches_.resize(boxes.size());
      for (std::size_t i = 0; i < boxes.size(); ++i)
      {
        stretches_[i].group = static_cast<Index>(i);
      }
    }
    for (Stretch& stretch : stretches_)
    {
      const double* const v = boxes[stretch.group].v;
      stretch.begin = first ? v[axis] : v[axis + 3];
      stretch.end = first ? -v[axis + 3] : -v[axis];
    }
    anew ? std::sort(stretches_.begin(), stretches_.end(), before) : sortFromLastOrder();
  }

  const std::vector<Stretch>& stretches() const { return stretches_; }

 private:
  static bool before(const Stretch& a, const Stretch& b)
  {
    return a.begin != b.begin ? a.begin < b.begin : a.group < b.group;
  }

  void sortFromLastOrder()
  {
    // A few moves a group; if there are more, the old order is no help.
    std::size_t left = 16 * stretches_.size();
    for (std::size_t next = 1; next < stretches_.size(); ++next)
    {
      const Stretch stretch = stretches_[next];
      std::size_t place = next;
      for (; place > 0 && before(stretch, stretches_[place - 1]); --place)
      {
        stretches_[place] = stretches_[place - 1];
      }
      stretches_[place] = stretch;
      if (next - place > left)
      {
        std::sort(stretches_.begin(), stretches_.end(), before);
        return;
      }
      left -= next - place;
    }
  }

  std::vector<Stretch> stretches_;
  std::uint32_t refits_ = 0;
};

/** Sweeps along one axis over the groups of both sets that are where both sets are. */
class SweepPairs : public GroupPairs
{
 public:
  using GroupPairs::GroupPairs;

 protected:
  void search() override
  {
    if (axis_ < 0)
    {
      axis_ = longestAxis();
    }
    first_order_.sort(first_, axis_, true);
    second_order_.sort(second_, axis_, false);
    select(first_order_, first_, second_, true, first_there_);
    select(second_order_, second_, first_, false, second_there_);
    std::size_t i = 0, j = 0;
    while (i < first_there_.size() && j < second_there_.size())
    {
      const Stretch &a = first_there_[i], &b = second_there_[j];
      if (a.begin <= b.begin)
      {
        for (std::size_t k = j; k < second_there_.size() && second_there_[k].begin <= a.end; ++k)
        {
          joinIfNear(a.group, second_there_[k].group);
        }
        ++i;
      }
      else
      {
        for (std::size_t k = i; k < first_there_.size() && first_there_[k].begin <= b.end; ++k)
        {
          joinIfNear(first_there_[k].group, b.group);
        }
        ++j;
      }
    }
  }

 private:
  int longestAxis() const
  {
    const double* const v = second_.bounds().v;
    const double lengths[3] = {-v[0] - v[3], -v[1] - v[4], -v[2] - v[5]};
    return static_cast<int>(std::max_element(lengths, lengths + 3) - lengths);
  }

  /** Those inside the bounds of the other set, where they may be by now. */
  void select(const SweepOrder& order, const ElementGroups& own, const ElementGroups& other,
              bool first, std::vector<Stretch>& there) const
  {
    const BoxEnds& all = other.level(other.levels() - 1)[0];
    const double begin = own.drift().v[first ? axis_ : axis_ + 3];
    const double end = -own.drift().v[first ? axis_ + 3 : axis_];
    there.clear();
    for (const Stretch& stretch : order.stretches())
    {
      if (overlap(own.level(0)[stretch.group], all, slack_))
      {
        there.push_back({stretch.begin + begin, stretch.end + end, stretch.group});
      }
    }
  }

  void joinIfNear(Index a, Index b)
  {
    if (overlap(first_.level(0)[a], second_.level(0)[b], slack_))
    {
      join(a, b);
    }
  }

  int axis_ = -1;
  SweepOrder first_order_, second_order_;
  std::vector<Stretch> first_there_, second_there_;
};
}  // namespace

std::unique_ptr<PairFinder> makeSweepPairs(const ElementSet& first, const ElementSet& second,
                                           bool one_body)
{
  return std::make_unique<SweepPairs>(first, second, one_body);
}

}  // namespace soft_tissue
