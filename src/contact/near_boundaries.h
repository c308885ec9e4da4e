#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "soft_tissue_sim/contact/tissue_depth.h"

namespace soft_tissue
{
/** What is known of the boundary near the samples of a surface, from one time they are taken to the
 * next. */
class NearBoundaries
{
 public:
  /** Samples are to be taken once more. */
  void restart()
  {
    std::swap(last_, now_);
    now_.clear();
    next_ = 0;
  }

  /** Of a sample of an element, which come in ascending order. It stays until the next call. */
  NearBoundary& of(Index element, int number)
  {
    const std::uint64_t name =
        (static_cast<std::uint64_t>(element) << 32) | static_cast<std::uint32_t>(number);
    while (next_ < last_.size() && last_[next_].first < name)
    {
      ++next_;
    }
    const bool known = next_ < last_.size() && last_[next_].first == name;
    now_.emplace_back(name, known ? last_[next_++].second : NearBoundary());
    return now_.back().second;
  }

 private:
  std::vector<std::pair<std::uint64_t, NearBoundary>> last_, now_;
  std::size_t next_ = 0;  ///< in last_
};

}  // namespace soft_tissue
