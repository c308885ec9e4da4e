#include "group_pairs.h"

namespace soft_tissue
{
GroupPairs::GroupPairs(const ElementSet& first, const ElementSet& second, bool one_body)
    : first_(first, ElementGroups::Role::first),
      second_(second, ElementGroups::Role::second),
      slack_(),
      one_body_(one_body),
      order_(second.count)
{}

void GroupPairs::find(const Vec3* x_first, const Vec3* x_second, double margin,
                      std::vector<ElementPair>& pairs)
{
  pairs.clear();
  first_.place(x_first, margin);
  second_.place(x_second, 0.0);
  if (!overlap(first_.bounds(), second_.bounds()))
  {
    return;
  }
  first_.refitIfNeeded();
  second_.refitIfNeeded();
  for (int k = 0; k < 6; ++k)
  {
    slack_.v[k] = -(first_.drift().v[k] + second_.drift().v[k]);
  }
  found_count_ = 0;
  search();
  order_.arrange(found_.data(), found_count_, pairs);
}

void GroupPairs::join(Index first_group, Index second_group)
{
  first_.open(first_group);
  second_.open(second_group);
  if (!overlap(first_.groupBox(first_group), second_.groupBox(second_group)))
  {
    return;
  }
  // Without branches on what is found: a list takes each candidate, and grows if it is one.
  constexpr int kSize = ElementGroups::kSize;
  Index near[kSize], hits[kSize];  // of the second group: at the first, at an element of it
  int count = 0;
  for (Index j = second_.begin(second_group); j < second_.end(second_group); ++j)
  {
    near[count] = j;
    count += overlap(first_.groupBox(first_group), second_.box(j)) ? 1 : 0;
  }
  if (found_.size() < found_count_ + kSize * kSize)
  {
    found_.resize(2 * found_.size() + kSize * kSize);
  }
  ElementPair* next = found_.data() + found_count_;
  for (Index i = first_.begin(first_group); count > 0 && i < first_.end(first_group); ++i)
  {
    const BoxEnds& box = first_.box(i);
    if (!overlap(box, second_.groupBox(second_group)))
    {
      continue;
    }
    int hit_count = 0;
    for (int k = 0; k < count; ++k)
    {
      hits[hit_count] = near[k];
      hit_count += overlap(box, second_.box(near[k])) ? 1 : 0;
    }
    for (int k = 0; k < hit_count; ++k)
    {
      *next = {first_.element(i), second_.element(hits[k])};
      next += one_body_ && shareNode(i, hits[k]) ? 0 : 1;
    }
  }
  found_count_ = next - found_.data();
}

}  // namespace soft_tissue
