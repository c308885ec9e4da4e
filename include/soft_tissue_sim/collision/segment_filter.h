#pragma once

#include <array>
#include <cstring>
#include <vector>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/geometry/meeting_kernels.h"

namespace soft_tissue
{
/**
 * Drops segments that surely miss a tet, eight at a time in single precision: clipSegment() would
 * find nothing of them. Most candidates of a search by boxes are such.
 */
class SegmentFilter
{
 public:
  SegmentFilter();

  void clear();
  /** The tet of the segments that follow; corners in m, in any order. */
  void setTet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
  /** A segment, which may be a point, m, by any number. */
  void add(Index number, const Vec3& a, const Vec3& b)
  {
    setPoint(lanes_.ends[0][count_], a);
    setPoint(lanes_.ends[1][count_], b);
    for (int k = 0; k < 3; ++k)
    {
      std::memcpy(lanes_.tet[k][count_], corners_[k], sizeof(corners_[k]));
    }
    numbers_[count_++] = number;
    if (count_ == kMeetingLanes)
    {
      sift();
    }
  }
  /** Numbers of those that may meet their tets, in the order in which they were added. */
  const std::vector<Index>& left()
  {
    sift();
    return left_;
  }

 private:
  void setPoint(float (&place)[4], const Vec3& p) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = static_cast<float>(p[axis] - origin_[axis]);
    }
  }
  void sift();

  const MeetingKernels* kernels_;
  Vec3 origin_;  ///< first corner of the tet
  float corners_[3][4] = {};
  TetSegmentLanes lanes_ = {};
  std::array<Index, kMeetingLanes> numbers_ = {};
  int count_ = 0;  ///< lanes in use
  std::vector<Index> left_;
};

}  // namespace soft_tissue
