#pragma once

#include <cmath>
#include <vector>

#include "quadrature.h"
#include "soft_tissue_sim/collision/inside_intervals.h"
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

/**
 * Appends the samples of a stretch of an edge, and of its ends where they are on the surface.
 * @param along     the whole edge, m
 * @param sampleAt  sampleAt(parameter, weight, sample) measures there, by ascending parameters; a
 *                  whole edge has weight 1; false where nothing presses
 */
template <std::size_t N, typename SampleAt>
void addStretch(const std::array<QuadraturePoint, N>& rule, const InsideInterval& inside,
                const Vec3& along, const SampleAt& sampleAt, std::vector<ContactSample>& samples)
{
  MovingEnds ends(inside.where, along);
  ContactSample begin;
  if (inside.begin_on_surface)
  {
    sampleAt(inside.where.begin, 1.0, begin);
  }
  forEachPoint(rule, inside.where, [&](double parameter, double weight) {
    ContactSample sample;
    if (sampleAt(parameter, weight, sample))
    {
      ends.count(sample, parameter);
      samples.push_back(sample);
    }
  });
  if (inside.begin_on_surface && ends.close(begin, true))
  {
    samples.push_back(begin);
  }
  ContactSample end;
  if (inside.end_on_surface)
  {
    sampleAt(inside.where.end, 1.0, end);
    if (ends.close(end, false))
    {
      samples.push_back(end);
    }
  }
}

}  // namespace soft_tissue
