#include "group_pairs.h"

#include <algorithm>

namespace soft_tissue
{
namespace
{
constexpr double kLeastHalf = 1e-200;  // m: its inverse is finite
/** A search looks this many calls ahead, if that is not too far. */
constexpr double kCallsAhead = 8.0;
/** Looking ahead for fewer calls costs as much as it saves: such a search takes up to three times
 * as long. */
constexpr double kLeastCalls = 4.0;
/** In shares of what is not too far: what still stands may move soon. */
constexpr double kLeastAhead = 0.2;
}  // namespace

GroupPairs::GroupPairs(const ElementSet& first, const ElementSet& second, bool one_body)
    : first_(first, ElementGroups::Role::first),
      second_(second, ElementGroups::Role::second),
      slack_(),
      one_body_(one_body),
      order_(second.count),
      kept_(first, second)
{}

void GroupPairs::find(const Vec3* x_first, const Vec3* x_second, double margin,
                      std::vector<ElementPair>& pairs)
{
  first_.place(x_first, margin);
  second_.place(x_second, 0.0);
  ++calls_;
  if (!overlap(first_.bounds(), second_.bounds()))
  {
    pairs.clear();
    return;
  }
  const bool finite = first_.allFinite() && second_.allFinite();
  const double nearer = nearerSinceRefit();
  if (finite && nearer + margin <= reach_)
  {
    kept_.select(x_first, x_second, margin, pairs);
    return;
  }
  const double ahead = finite ? lookAhead(nearer / calls_) : 0.0;
  if (ahead == 0.0)
  {
    reach_ = -1.0;
    const std::uint32_t refits = first_.refits() + second_.refits();
    first_.refitIfNeeded();
    second_.refitIfNeeded();
    calls_ = refits == first_.refits() + second_.refits() ? calls_ : 0;
    searchAll(pairs);
    return;
  }
  first_.refit();
  second_.refit();
  first_.widen(ahead);
  searchAll(pairs);
  kept_.keep(pairs);
  reach_ = margin + ahead;
  calls_ = 0;
  kept_.select(x_first, x_second, margin, pairs);
}

/** How much nearer to each other elements may have come along an axis since the boxes of both trees
 * were made, with rounding, m. */
double GroupPairs::nearerSinceRefit() const
{
  double nearer = 0.0;
  for (int k = 0; k < 6; ++k)
  {
    nearer = std::max(nearer, -(first_.drift().v[k] + second_.drift().v[k]));
  }
  return nearer + first_.rounding() + second_.rounding();
}

/** How much farther to search for pairs to keep, by how fast elements came nearer, m; 0: not. */
double GroupPairs::lookAhead(double nearer_a_call) const
{
  const double most = std::min(first_.slack(), second_.slack());
  return most > 0.0 && kLeastCalls * nearer_a_call <= most
             ? std::clamp(kCallsAhead * nearer_a_call, kLeastAhead * most, most)
             : 0.0;
}

void GroupPairs::searchAll(std::vector<ElementPair>& pairs)
{
  first_.addMarginToDrift();
  second_.addMarginToDrift();
  for (int k = 0; k < 6; ++k)
  {
    slack_.v[k] = -(first_.drift().v[k] + second_.drift().v[k]);
  }
  setLaneScale();
  found_count_ = 0;
  search();
  if (never_)
  {
    const auto never = [this](const ElementPair& pair) { return never_(pair); };
    const auto end = found_.begin() + static_cast<std::ptrdiff_t>(found_count_);
    found_count_ = std::remove_if(found_.begin(), end, never) - found_.begin();
  }
  order_.arrange(found_.data(), found_count_, pairs);
}

// Lanes count from the middle of what is in both bounds, to its sides.
void GroupPairs::setLaneScale()
{
  BoxEnds first, second, per_metre;
  for (int k = 0; k < 3; ++k)
  {
    const double low = std::max(first_.bounds().v[k], second_.bounds().v[k + 3]);
    const double high = std::min(-first_.bounds().v[k + 3], -second_.bounds().v[k]);
    const double half = std::max(0.5 * (high - low), kLeastHalf);
    first.v[k] = second.v[k + 3] = 0.5 * (low + high);
    first.v[k + 3] = second.v[k] = -0.5 * (low + high);
    per_metre.v[k] = per_metre.v[k + 3] = LaneScale::kMost / half;
  }
  first_.setLaneScale(first, per_metre);
  second_.setLaneScale(second, per_metre);
}

void GroupPairs::join(Index first_group, Index second_group)
{
  first_.open(first_group);
  second_.open(second_group);
  if (!overlap(first_.groupBox(first_group), second_.groupBox(second_group)))
  {
    return;
  }
  constexpr std::size_t kMost = ElementGroups::kSize * ElementGroups::kSize;
  if (found_.size() < found_count_ + kMost)
  {
    found_.resize(2 * found_.size() + kMost);
  }
  ElementPair* next = found_.data() + found_count_;
  const BoxLanes& lanes = first_.lanes(first_group);
  const BoxLanes& other_lanes = second_.lanes(second_group);
  NearLanes(lanes, second_.groupLane(second_group)).forEach([&](int i) {
    const Index place = first_.begin(first_group) + i;
    NearLanes(other_lanes, lanes.lane(i)).forEach([&](int j) {
      const Index other = second_.begin(second_group) + j;
      if (one_body_ && shareNode(place, other))  // most of what is near in one body
      {
        return;
      }
      *next = {first_.element(place), second_.element(other)};
      next += overlap(first_.box(place), second_.box(other)) ? 1 : 0;
    });
  });
  found_count_ = next - found_.data();
}

}  // namespace soft_tissue
