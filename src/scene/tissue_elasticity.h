#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/energy/elasticity.h"

namespace soft_tissue
{
struct TissueModel;

/** Elasticity of a tissue: a term for each of the laws its elements have. */
class TissueElasticity
{
 public:
  /** @param first_node  row of the tissue's node 0 among all positions */
  TissueElasticity(const TissueModel& model, Index first_node);

  void addTerms(std::vector<EnergyTerm*>& terms) const;

  /** Smallest det F of all elements. */
  double minDetF(const Points& x) const;

  /** Equivalent (von Mises) stress per tet of TissueInfo::rest, Pa. */
  void vonMises(const Points& x, std::vector<float>& stress);

 private:
  /** The elements of one law. */
  struct Part
  {
    std::unique_ptr<Elasticity> energy;
    std::vector<Index> elements;  ///< their numbers in the tissue, ascending
    std::vector<float> stress;
  };
  std::vector<Part> parts_;
};

}  // namespace soft_tissue
