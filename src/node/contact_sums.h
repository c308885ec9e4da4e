#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue_sim
{
/** What the contacts of one tool or one pair of tissues come to. */
struct ContactSums
{
  soft_tissue::Vec3 force_W = soft_tissue::Vec3::Zero();  ///< N, on the tool or the first
  double deepest_m = 0.0;
};

inline ContactSums sumOf(const std::vector<soft_tissue::ContactPoint>& contacts)
{
  ContactSums sums;
  for (const soft_tissue::ContactPoint& contact : contacts)
  {
    sums.force_W += contact.force_W;
    sums.deepest_m = std::max(sums.deepest_m, contact.depth);
  }
  return sums;
}

}  // namespace soft_tissue_sim
