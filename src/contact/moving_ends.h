#pragma once

#include <cmath>

#include "soft_tissue_sim/collision/interval.h"
#include "soft_tissue_sim/contact/contact_sample.h"

namespace soft_tissue
{
/**
 * What the motion of a clipped stretch's ends does to a quadrature over it.
 *
 * For an exact rule nothing, as the depth is zero there; for a sum Q of s_k d_k^2 / 2 at points
 * that divide the stretch in fixed ratios, dQ/dbegin and dQ/dend are small and known. With d(end;
 * x) = 0 they become forces along the surface's normal at the clip point, equal and opposite on
 * both bodies: value and gradient then belong together to rounding, whatever the depth does in
 * between.
 */
class MovingEnds
{
 public:
  /** @param along  the whole segment, last point minus first, m */
  MovingEnds(const Interval& stretch, const Vec3& along) : stretch_(stretch), along_(along) {}

  /** Counts a quadrature point at a parameter of the segment. */
  void count(const ContactSample& sample, double parameter)
  {
    const double length = stretch_.end - stretch_.begin;
    const double share = (parameter - stretch_.begin) / length;
    const double slope = sample.gradient.dot(along_);
    by_begin_ += sample.force * (slope * (1.0 - share) - 0.5 * sample.excess() / length);
    by_end_ += sample.force * (slope * share + 0.5 * sample.excess() / length);
  }

  /** Turns a sample at the stretch's begin or end into the force of its motion; false where it
   * grazes. */
  bool close(ContactSample& sample, bool at_begin) const
  {
    constexpr double kGrazing = 1e-3;    // sine of the angle to the surface
    constexpr double kOnSurface = 1e-6;  // of the segment's length
    const double slope = sample.gradient.dot(along_);
    const double length = along_.norm();
    if (std::abs(slope) < kGrazing * length || std::abs(sample.depth) > kOnSurface * length)
    {
      return false;
    }
    sample.force = -(at_begin ? by_begin_ : by_end_) / slope;
    sample.depth = sample.allowed = sample.area = sample.stiffness_area = 0.0;
    return true;
  }

 private:
  Interval stretch_;
  Vec3 along_;
  double by_begin_ = 0.0;  ///< dQ/dbegin, J
  double by_end_ = 0.0;
};

}  // namespace soft_tissue
