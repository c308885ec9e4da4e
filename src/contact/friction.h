#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/**
 * Coulomb friction between a rigid tool and a tissue as a potential of how far the tissue slides
 * along the tool during a step.
 *
 * Where it acts, how hard both press and along which plane is that of the step's start. Slower than
 * a stick speed the force grows smoothly with the speed; that is how far a hold creeps. The
 * potential is convex.
 *
 * Source: [Li2020] section 5, the smoothed and lagged friction of incremental potential contact.
 */
class Friction
{
 public:
  explicit Friction(double coefficient) : coefficient_(coefficient) {}

  bool acts() const { return coefficient_ > 0.0; }

  /**
   * Takes the contacts a step starts with.
   * @param samples      at x, with the tool at X_WT_before
   * @param x            positions of all nodes at the start of the step, m
   * @param X_WT_before  tool pose at its start
   * @param X_WT         tool pose at its end
   * @param step_s       its length, > 0
   */
  void lag(const std::vector<ContactSample>& samples, const Points& x, const Pose& X_WT_before,
           const Pose& X_WT, double step_s);

  double value(const Points& x) const;
  void addGradient(const Points& x, Points& gradient) const;
  /** Exact, and never indefinite. */
  void addHessian(const Points& x, BlockMatrix& hessian) const;

  /** All forces at x. */
  const std::vector<FrictionForce>& forcesAt(const Points& x);

 private:
  /** A place where both touch: the tissue is there with these weights of its nodes. */
  struct Touch
  {
    Vec3 normal;      ///< away from the tissue, unit
    double strength;  ///< coefficient times normal force, N
    Vec3 carried_to;  ///< where the tissue's point would be at the end if it stuck to the tool, m
    int count;
    std::array<Index, ContactSample::kMaxNodes> node;
    std::array<double, ContactSample::kMaxNodes> weight;
  };

  double forcePerSlip(const Touch& touch, double slip) const;
  static Vec3 pointOf(const Touch& touch, const Points& x);
  static Vec3 slip(const Touch& touch, const Points& x);

  double coefficient_;
  double stick_m_ = 0.0;  ///< slip below which the force is not full
  std::vector<Touch> touches_;
  std::vector<FrictionForce> forces_;
};

}  // namespace soft_tissue
