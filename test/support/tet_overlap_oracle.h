#pragma once

#include <array>
#include <cstdint>
#include <utility>

namespace soft_tissue::test
{
/** Corners with whole numbers for coordinates, up to 200. */
using WholeTet = std::array<std::array<std::int64_t, 3>, 4>;

/**
 * Whether the columns' equation has a solution without negative numbers, found exactly by
 * elimination without fractions (Bareiss); nothing else counts where columns depend on each other,
 * as fewer of them do then.
 */
inline bool solvedWithoutNegatives(std::array<std::array<std::int64_t, 6>, 5> m, int columns)
{
  std::int64_t last = 1;
  for (int k = 0; k < columns; ++k)
  {
    int pivot = k;
    while (pivot < 5 && m[pivot][k] == 0)
    {
      ++pivot;
    }
    if (pivot == 5)
    {
      return false;  // dependent
    }
    std::swap(m[k], m[pivot]);
    for (int row = 0; row < 5; ++row)
    {
      for (int column = 5; row != k && column >= 0; --column)
      {
        if (column != k)
        {
          m[row][column] = (m[k][k] * m[row][column] - m[row][k] * m[k][column]) / last;
        }
      }
      m[row][k] = row == k ? m[row][k] : 0;
    }
    last = m[k][k];
  }
  for (int row = 0; row < 5; ++row)
  {
    const bool fits = row < columns ? (last > 0 ? m[row][5] >= 0 : m[row][5] <= 0) : m[row][5] == 0;
    if (!fits)
    {
      return false;
    }
  }
  return true;
}

/**
 * Whether two tets have a point in common, exactly: weights of the corners that are not negative,
 * add up to one in each tet and give the same point in both. If there are any, there are some of
 * which at most five, with independent equations, are not zero: all choices are tried.
 */
inline bool exactlyOverlap(const WholeTet& a, const WholeTet& b)
{
  for (unsigned choice = 1; choice < 256; ++choice)
  {
    std::array<std::array<std::int64_t, 6>, 5> equations = {};
    int columns = 0;
    for (int corner = 0; corner < 8 && columns <= 5; ++corner)
    {
      if ((choice >> corner & 1) == 0)
      {
        continue;
      }
      for (int row = 0; row < 3 && columns < 5; ++row)
      {
        equations[row][columns] = corner < 4 ? a[corner][row] : -b[corner - 4][row];
      }
      if (columns < 5)
      {
        equations[corner < 4 ? 3 : 4][columns] = 1;
      }
      ++columns;
    }
    equations[3][5] = equations[4][5] = 1;
    if (columns <= 5 && solvedWithoutNegatives(equations, columns))
    {
      return true;
    }
  }
  return false;
}

}  // namespace soft_tissue::test
