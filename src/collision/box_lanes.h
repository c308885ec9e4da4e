#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "soft_tissue_sim/collision/box_ends.h"

namespace soft_tissue
{
/** The ends of a box, roughly. */
using LaneBox = std::array<std::int16_t, 6>;

/** Maps ends of boxes to whole numbers, the same for both sets: never so that boxes that overlap
 * seem apart, as larger ends get no smaller numbers and opposite ones opposite numbers. */
struct LaneScale
{
  static constexpr double kMost = 8191.0;

  BoxEnds origin;
  BoxEnds per_metre;

  LaneBox operator()(const BoxEnds& ends) const
  {
    LaneBox lane;
    for (int k = 0; k < 6; ++k)
    {
      const double place = (ends.v[k] - origin.v[k]) * per_metre.v[k];
      lane[k] = static_cast<std::int16_t>(std::min(std::max(place, -kMost), kMost));
    }
    return lane;
  }
};

/** Boxes of a group side by side, roughly: sixteen are compared at once. */
struct BoxLanes
{
  static constexpr int kCount = 16;
  /** An end of what is no box: in no sum with another end is it below zero. */
  static constexpr std::int16_t kNothing = 16383;

  std::int16_t v[6][kCount];

  LaneBox lane(int number) const
  {
    return {v[0][number], v[1][number], v[2][number], v[3][number], v[4][number], v[5][number]};
  }
};

/** The lanes of a group that may overlap a box. */
class NearLanes
{
 public:
  NearLanes(const BoxLanes& lanes, const LaneBox& box)
  {
    using Numbers = std::int16_t __attribute__((vector_size(32)));
    using Bytes = std::int8_t __attribute__((vector_size(16)));
    Numbers most = {};
    for (int k = 0; k < 6; ++k)
    {
      Numbers ends;
      std::memcpy(&ends, lanes.v[k], sizeof(ends));
      ends += box[k];
      most = k == 0 ? ends : (ends > most ? ends : most);
    }
    const Bytes near = __builtin_convertvector(most <= 0, Bytes);
    std::memcpy(halves_, &near, sizeof(halves_));
  }

  template <typename Visit>
  void forEach(const Visit& visit) const
  {
    for (int half = 0; half < 2; ++half)
    {
      for (std::uint64_t bits = halves_[half] & 0x0101010101010101u; bits != 0; bits &= bits - 1)
      {
        visit(8 * half + __builtin_ctzll(bits) / 8);
      }
    }
  }

 private:
  std::uint64_t halves_[2];  ///< a byte a lane
};

}  // namespace soft_tissue
