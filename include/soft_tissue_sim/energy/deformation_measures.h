#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** What can be told of a body of tets as it is deformed, whatever holds it together. */
class DeformationMeasures
{
 public:
  virtual ~DeformationMeasures() = default;

  /** Smallest det F of all tets: 1 at rest, <= 0 when one is inverted. */
  virtual double minDetF(const Points& x) = 0;

  /** Equivalent (von Mises) Cauchy stress, Pa: one per linear tet, one per part of a quadratic
   * one. */
  virtual void vonMises(const Points& x, std::vector<float>& stress) = 0;
};

}  // namespace soft_tissue
