#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "soft_tissue_sim/base/index.h"

namespace soft_tissue
{
/** All triangles of a surface that are nearer to a point than some radius, few as they are. */
class Shortlist
{
 public:
  static constexpr int kMost = 6;

  int size() const { return size_; }
  Index operator[](int i) const { return triangle_[i]; }
  double distance(int i) const { return distance_[i]; }  ///< m, ascending

  /** What is not in the list is at least this far, m. */
  double radius() const { return radius_; }

  /** Takes a triangle in that is nearer than the radius, m; where there are too many the farthest
   * goes, and limits the radius. */
  void add(Index triangle, double distance)
  {
    if (!(distance < radius_))
    {
      return;
    }
    if (size_ == kMost)
    {
      radius_ = std::max(distance, distance_[kMost - 1]);
      if (radius_ == distance)
      {
        return;
      }
      --size_;
    }
    int place = size_++;
    for (; place > 0 && distance_[place - 1] > distance; --place)
    {
      distance_[place] = distance_[place - 1];
      triangle_[place] = triangle_[place - 1];
    }
    distance_[place] = distance;
    triangle_[place] = triangle;
  }

  /** Drops what is not nearer than this, m. */
  void shrink(double radius)
  {
    radius_ = std::min(radius_, radius);
    while (size_ > 0 && !(distance_[size_ - 1] < radius_))
    {
      --size_;
    }
  }

 private:
  std::array<Index, kMost> triangle_{};
  std::array<double, kMost> distance_{};
  int size_ = 0;
  double radius_ = std::numeric_limits<double>::infinity();
};

}  // namespace soft_tissue
