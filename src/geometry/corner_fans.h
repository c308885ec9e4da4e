#pragma once

#include <array>
#include <cstdint>

namespace soft_tissue
{
/**
 * Which of the twelve faces around a corner of a grid belong to one sheet of the surface.
 *
 * Cells around the corner are numbered x + 2 y + 4 z, 0 being the lower side; the face between
 * cells along axis a is number 4 a + b + 2 c, where b and c are its cells' sides along the two axes
 * that follow a. Occupied cells that share no face are apart: where they meet in an edge or a point
 * only, each has its own sheet, so every sheet is a manifold.
 */
struct CornerFans
{
  static constexpr int kMost = 4;
  int count = 0;                      ///< sheets that meet at the corner
  std::array<std::int8_t, 12> fan{};  ///< of each face; -1: it is not on the surface
};

/** Of the cells whose bits are set. */
const CornerFans& cornerFans(unsigned occupied);

}  // namespace soft_tissue
