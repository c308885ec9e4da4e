#pragma once

#include <cmath>
#include <limits>

namespace soft_tissue
{
/** One axis' share of the upwind equation: weight (u - start)^2, for u above `least`. */
struct Difference
{
  double weight, start, least;
};

/** Puts one more among those there are, by what u has to be above. */
inline void insert(Difference* differences, int& count, const Difference& one)
{
  int place = count++;
  for (; place > 0 && one.least < differences[place - 1].least; --place)
  {
    differences[place] = differences[place - 1];
  }
  differences[place] = one;
}

/** The largest u with sum of weight (u - start)^2 = 1 in which no difference points downwind. */
inline double solveUpwind(const Difference* differences, int count)
{
  double a = 0.0, b = 0.0, c = -1.0, u = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < count; ++k)
  {
    const Difference& d = differences[k];
    if (k > 0 && u <= d.least)
    {
      break;
    }
    const double start = d.start - differences[0].start;  // so that little cancels
    a += d.weight;
    b += d.weight * start;
    c += d.weight * start * start;
    const double discriminant = b * b - a * c;
    if (k > 0 && discriminant < 0.0)
    {
      break;
    }
    u = differences[0].start + (b + std::sqrt(discriminant)) / a;
  }
  return u;
}

}  // namespace soft_tissue
