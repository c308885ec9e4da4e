#include "soft_tissue_sim/geometry/halving_order.h"

#include <algorithm>
#include <numeric>

namespace soft_tissue
{
namespace
{
/** So many points stay in the order of their numbers. */
constexpr std::size_t kFew = 16;

std::vector<Index> numbersOf(const Points& points)
{
  std::vector<Index> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}
}  // namespace

std::vector<Index> halvingOrder(const Points& points)
{
  std::vector<Index> order = numbersOf(points);
  Index parts = 1;
  while (points.size() / parts > kFew)
  {
    parts *= 2;
  }
  halve(points, order.begin(), order.end(), parts,
        [](auto begin, auto end, Index) { std::sort(begin, end); });
  return order;
}

std::vector<int> halvedParts(const Points& points, int halvings)
{
  std::vector<Index> numbers = numbersOf(points);
  std::vector<int> parts(points.size());
  halve(points, numbers.begin(), numbers.end(), 1 << halvings,
        [&](auto begin, auto end, Index part) {
          std::for_each(begin, end, [&](Index i) { parts[i] = part; });
        });
  return parts;
}

}  // namespace soft_tissue
