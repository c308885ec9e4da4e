#include "pair_order.h"

#include <algorithm>

namespace soft_tissue
{
namespace
{
/** Few elements are put in order faster one by one. */
constexpr Index kFew = 24;

void orderByFirst(ElementPair* begin, ElementPair* end)
{
  if (end - begin > kFew)
  {
    std::sort(begin, end,
              [](const ElementPair& a, const ElementPair& b) { return a.first < b.first; });
    return;
  }
  for (ElementPair* next = begin; next != end; ++next)
  {
    const ElementPair pair = *next;
    ElementPair* place = next;
    for (; place != begin && (place - 1)->first > pair.first; --place)
    {
      *place = *(place - 1);
    }
    *place = pair;
  }
}
}  // namespace

PairOrder::PairOrder(Index second_count)
    : places_(second_count, 0), named_((static_cast<std::size_t>(second_count) + 63) / 64, 0)
{}

void PairOrder::arrange(const ElementPair* found, std::size_t count,
                        std::vector<ElementPair>& pairs)
{
  for (const ElementPair* pair = found; pair != found + count; ++pair)
  {
    ++places_[pair->second];
    named_[pair->second / 64] |= std::uint64_t{1} << (pair->second % 64);
  }
  const auto forEachNamed = [&](const auto& visit) {
    for (std::size_t word = 0; word < named_.size(); ++word)
    {
      for (std::uint64_t bits = named_[word]; bits != 0; bits &= bits - 1)
      {
        visit(static_cast<Index>(64 * word) + __builtin_ctzll(bits));
      }
    }
  };
  Index total = 0;
  forEachNamed([&](Index second) {
    const Index begin = total;
    total += places_[second];
    places_[second] = begin;
  });
  pairs.resize(count);
  for (const ElementPair* pair = found; pair != found + count; ++pair)
  {
    pairs[places_[pair->second]++] = *pair;
  }
  Index begin = 0;
  forEachNamed([&](Index second) {
    orderByFirst(pairs.data() + begin, pairs.data() + places_[second]);
    begin = places_[second];
    places_[second] = 0;
  });
  std::fill(named_.begin(), named_.end(), 0);
}

}  // namespace soft_tissue
