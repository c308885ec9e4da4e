#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/tissue_body.h"
#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/field/distance_field.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"

namespace soft_tissue
{
/** How contact between a tool and a tissue is modelled. */
struct ToolContactOptions
{
  bool segments = true;         ///< segment-in-object; false: point-in-object
  bool closest_feature = true;  ///< depth from the nearest boundary feature; false: interpolated
  bool lazy_field = true;       ///< march only as far as contacts read, and only when they do
  double stiffness_pa_per_m = 0.0;  ///< kappa
  double friction = 0.0;            ///< Coulomb coefficient, >= 0
};

/** Wall time of a contact's parts since the last call of takeTimes(), s. */
struct ContactTimes
{
  double field = 0.0;
  double detect = 0.0;
  double respond = 0.0;
};

/**
 * Penalty contact of one rigid tool with one tissue: tool surface in the tissue's depth, and tissue
 * surface in the tool's exact distance, each the integral of 1/2 kappa d^2 dA, averaged; and
 * Coulomb friction between them.
 *
 * beginStep() lags what the minimisation holds fixed: tool pose, candidate elements, surface areas,
 * nodal depths, and where and how hard friction acts.
 */
class ToolContact : public EnergyTerm
{
 public:
  ToolContact(const TissueBody& tissue, const RigidBodyShape& tool,
              std::unique_ptr<DistanceField> field, const ToolContactOptions& options);
  ~ToolContact() override;

  /**
   * Takes the state a step starts from.
   * @param x            positions at the start of the step
   * @param X_WT_before  tool pose at the start of the step
   * @param X_WT         tool pose at its end: the pose contact is evaluated at
   * @param step_s       length of the step, > 0
   * @param refresh      march the nodal depths anew on x; false keeps those there are and marches
   * on x only where a contact reads a node that has none yet
   */
  void beginStep(const Points& x, const Pose& X_WT_before, const Pose& X_WT, double step_s,
                 bool refresh);

  /** Has the nodal depths marched anew before they are next read, whatever beginStep() is told. */
  void forgetField();

  /** Multiplies the options' stiffness from now on; 1 at first. */
  void setStiffening(double factor);
  double stiffening() const;

  /** Largest depth of the samples at x, m. */
  double deepest(const Points& x);

  /** False when nothing can touch during this step: value, gradient and Hessian are then zero. */
  bool active() const;

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  /** Exact but for what the motion of clip points adds, and of the kinks of an interpolated depth;
   * its positive part is what a depth without curvature would give. */
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

  /** The samples at x, world frame; valid until the next call of any member. */
  const std::vector<ContactSample>& samples(const Points& x);

  /** Friction at x, where contacts were when the step began; valid until the next call of any
   * member. */
  const std::vector<FrictionForce>& frictionForces(const Points& x);

  /** Nodal depths of the last field; all NaN before the first. */
  const std::vector<double>& depth() const;

  ContactTimes takeTimes();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace soft_tissue
