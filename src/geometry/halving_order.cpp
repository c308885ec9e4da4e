#include "soft_tissue_sim/geometry/halving_order.h"

#include <algorithm>
#include <numeric>

namespace soft_tissue
{
namespace
{
using Numbers = std::vector<Index>::iterator;

/** So many points stay in the order of their numbers. */
constexpr std::ptrdiff_t kFew = 16;

/** Halves points again and again; visit(begin, end, part) sees what is left of each part. */
template <typename Visit>
void halve(const Points& points, Numbers begin, Numbers end, int halvings, int part,
           const Visit& visit)
{
  if (halvings == 0 || end - begin <= 1)
  {
    visit(begin, end, part << halvings);
    return;
  }
  Vec3 low = points[*begin], high = low;
  std::for_each(begin, end, [&](Index i) {
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  });
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const Numbers middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, [&](Index i, Index j) {
    return points[i][axis] != points[j][axis] ? points[i][axis] < points[j][axis] : i < j;
  });
  halve(points, begin, middle, halvings - 1, 2 * part, visit);
  halve(points, middle, end, halvings - 1, 2 * part + 1, visit);
}

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
  int halvings = 0;
  while (static_cast<std::ptrdiff_t>(points.size()) >> halvings > kFew)
  {
    ++halvings;
  }
  halve(points, order.begin(), order.end(), halvings, 0,
        [](Numbers begin, Numbers end, int) { std::sort(begin, end); });
  return order;
}

std::vector<int> halvedParts(const Points& points, int halvings)
{
  std::vector<Index> numbers = numbersOf(points);
  std::vector<int> parts(points.size());
  halve(points, numbers.begin(), numbers.end(), halvings, 0,
        [&](Numbers begin, Numbers end, int part) {
          std::for_each(begin, end, [&](Index i) { parts[i] = part; });
        });
  return parts;
}

}  // namespace soft_tissue
