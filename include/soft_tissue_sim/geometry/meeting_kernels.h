#pragma once

#include <cstdint>

#include "soft_tissue_sim/base/cpu.h"

namespace soft_tissue
{
/** Pairs that are looked at side by side. */
constexpr int kMeetingLanes = 8;

/** Eight pairs of tets, in single precision, all as seen from the first tet's first corner. */
struct TetPairLanes
{
  alignas(32) float a[3][3][kMeetingLanes];  ///< corners 1 to 3 of the first tet: [corner][axis]
  alignas(32) float b[4][3][kMeetingLanes];  ///< corners of the second
};

/** Eight pairs of a tet and a segment, in single precision, as seen from the tet's first corner:
 * points as they come, each with a fourth number that does not count. */
struct TetSegmentLanes
{
  alignas(32) float tet[3][kMeetingLanes][4];   ///< corners 1 to 3: [corner][pair][axis]
  alignas(32) float ends[2][kMeetingLanes][4];  ///< of the segment
};

/** What single precision can tell. What it can't, be it that numbers are no numbers, is unclear. */
enum class Meeting : std::uint8_t
{
  unclear,
  apart,    ///< by far more than the tolerances of tetsOverlap()
  together  ///< by far more than rounding
};

/** Tells of pairs of lanes whether they meet; a bound on rounding decides what is unclear. */
struct MeetingKernels
{
  /** Separating planes: faces of either tet, and planes through edges of the first.
   * Source: [Ganovelli2002] edges by the heights over the faces beside them. */
  void (*tets)(const TetPairLanes& lanes, Meeting* meetings);
  /** Heights over the tet's faces.
   * @param margin  m
   * @return bit i: a face's plane parts pair i by more than the margin and rounding */
  unsigned (*segments)(const TetSegmentLanes& lanes, float margin);
};

/** The kernels for this machine. */
const MeetingKernels& meetingKernels(InstructionSet set);

}  // namespace soft_tissue
