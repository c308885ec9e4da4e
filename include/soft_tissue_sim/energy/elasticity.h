#pragma once

#include <algorithm>
#include <vector>

#include "soft_tissue_sim/energy/deformation_measures.h"
#include "soft_tissue_sim/energy/tet_term.h"

namespace soft_tissue
{
/** Elastic energy of the tets of one body: what linear and quadratic ones have in common. */
class Elasticity : public TetTerm, public DeformationMeasures
{
 public:
  double minDetF(const Points& x) override;
  void vonMises(const Points& x, std::vector<float>& stress) override;

 protected:
  /**
   * See TetTerm.
   * @param parameters  M
   */
  Elasticity(const TetKernels& kernels, const TetMesh& rest, const std::vector<Index>& stencils,
             const std::vector<TetStiffnessParameters>& parameters, Index first_node);

 private:
  friend class Viscosity;  // has the same tets, and makes the law stiffer

  /** What of lambda a tet's own strain meets; the rest is up to its nodes, see
   * NodalPressureTetElasticity. */
  double ownLambda(double lambda) const
  {
    return kernels().dilatation == nullptr ? lambda : std::min(lambda, 0.0);
  }

  void state(const Points& x, double* von_mises);

  std::vector<double> det_f_;      ///< per lane
  std::vector<double> von_mises_;  ///< [group][part][lane]; empty until asked for
};

}  // namespace soft_tissue
