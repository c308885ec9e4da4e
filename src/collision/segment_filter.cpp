#include "soft_tissue_sim/collision/segment_filter.h"

namespace soft_tissue
{
SegmentFilter::SegmentFilter() : kernels_(&meetingKernels(instructionSet())), origin_(Vec3::Zero())
{}

void SegmentFilter::clear()
{
  count_ = 0;
  left_.clear();
}

void SegmentFilter::setTet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  origin_ = a;
  const Vec3* const others[] = {&b, &c, &d};
  for (int k = 0; k < 3; ++k)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      corners_[k][axis] = static_cast<float>((*others[k])[axis] - a[axis]);
    }
  }
}

void SegmentFilter::sift()
{
  Meeting meetings[kMeetingLanes];
  if (count_ > 0)
  {
    kernels_->segments(lanes_, meetings);
  }
  for (int i = 0; i < count_; ++i)
  {
    if (meetings[i] != Meeting::apart)
    {
      left_.push_back(numbers_[i]);
    }
  }
  count_ = 0;
}

}  // namespace soft_tissue
