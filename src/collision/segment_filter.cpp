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
  setPoint(corners_[0], b);
  setPoint(corners_[1], c);
  setPoint(corners_[2], d);
}

void SegmentFilter::sift()
{
  if (count_ == 0)
  {
    return;
  }
  const unsigned used = (1u << count_) - 1u;
  for (unsigned bits = used & ~kernels_->segments(lanes_); bits != 0; bits &= bits - 1)
  {
    left_.push_back(numbers_[__builtin_ctz(bits)]);
  }
  count_ = 0;
}

}  // namespace soft_tissue
