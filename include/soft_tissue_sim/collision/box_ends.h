#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

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

inline BoxEnds noBox()
{
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {{kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, kInfinity}};
}

inline void extend(BoxEnds& ends, const BoxEnds& other)
{
  for (int k = 0; k < 6; ++k)
  {
    ends.v[k] = std::min(ends.v[k], other.v[k]);
  }
}

/** Sum of a box's edges, m. */
inline double edges(const BoxEnds& ends)
{
  return -(ends.v[0] + ends.v[1] + ends.v[2] + ends.v[3] + ends.v[4] + ends.v[5]);
}

}  // namespace soft_tissue
