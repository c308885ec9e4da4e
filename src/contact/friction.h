#pragma once

#include <vector>

#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/** Where two bodies press on each other when a step begins, and what sticking would mean there. */
struct Grip
{
  Vec3 normal;         ///< unit
  double press = 0.0;  ///< N along it
  int count = 0;
  /** With these weights of its nodes the point of the second body, less that of the first; the
   * former alone where the first is a tool. */
  std::array<Index, ContactSample::kMaxNodes> node{};
  std::array<double, ContactSample::kMaxNodes> weight{};
  Vec3 stuck_at;  ///< what those weights give at the end of the step if nothing slides, m
  Vec3 origin;    ///< added to what they give, where the friction acts, m

  Vec3 at(const Points& x) const
  {
    Vec3 point = Vec3::Zero();
    for (int j = 0; j < count; ++j)
    {
      point += weight[j] * x[node[j]];
    }
    return point;
  }
};

/**
 * Coulomb friction between two bodies as a potential of how far one slides along the other during a
 * step.
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

  /** Forgets all grips. @param step_s  length of the step that begins, > 0 */
  void begin(double step_s);
  void add(const Grip& grip) { grips_.push_back(grip); }

  double value(const Points& x) const;
  void addGradient(const Points& x, Points& gradient) const;
  /** Exact, and never indefinite. */
  void addHessian(const Points& x, BlockMatrix& hessian) const;

  /** All forces at x. */
  const std::vector<FrictionForce>& forcesAt(const Points& x);

 private:
  double forcePerSlip(const Grip& grip, double slip) const;

  double coefficient_;
  double stick_m_ = 0.0;  ///< slip of full friction
  std::vector<Grip> grips_;
  std::vector<FrictionForce> forces_;
};

}  // namespace soft_tissue
