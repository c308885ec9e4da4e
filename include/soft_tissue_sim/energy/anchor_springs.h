#pragma once

#include <vector>

#include "soft_tissue_sim/energy/term.h"

namespace soft_tissue
{
/** A node drawn to a place in the world. */
struct AnchorSpring
{
  Index node = 0;
  double stiffness = 0.0;     ///< N/m, >= 0
  Vec3 place = Vec3::Zero();  ///< m

  /** Force on whatever holds the place, N. */
  Vec3 force(const Points& x) const { return stiffness * (x[node] - place); }
};

/** 1/2 sum k |x - p|^2 over any nodes, also one node several times. */
class AnchorSprings : public EnergyTerm
{
 public:
  std::vector<AnchorSpring>& springs() { return springs_; }

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

 private:
  std::vector<AnchorSpring> springs_;
};

}  // namespace soft_tissue
