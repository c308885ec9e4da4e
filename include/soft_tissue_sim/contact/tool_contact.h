#pragma once

#include <memory>

#include "soft_tissue_sim/contact/contact_term.h"
#include "soft_tissue_sim/contact/tissue_body.h"
#include "soft_tissue_sim/field/distance_field.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"

namespace soft_tissue
{
/**
 * Contact of one rigid tool, the first of the pair, with one tissue: tool surface in the tissue's
 * depth, and tissue surface in the tool's exact distance. With a membrane it is the latter alone.
 *
 * beginStep() lags what the minimisation holds fixed: tool pose, candidate elements, surface areas,
 * nodal depths, and where and how hard friction acts.
 */
class ToolContact : public ContactTerm
{
 public:
  /** @param field  of the tissue, for this contact alone; null for a membrane */
  ToolContact(const TissueBody& tissue, const RigidBodyShape& tool,
              std::unique_ptr<DistanceField> field, const ContactOptions& options);
  ~ToolContact() override;

  /**
   * Takes the state a step starts from.
   * @param x            positions at the start of the step
   * @param X_WT_before  tool pose at the start of the step
   * @param X_WT         tool pose at its end: the pose contact is evaluated at
   * @param refresh      march the nodal depths anew on x; false keeps those there are and marches
   * on x only where a contact reads a node that has none yet
   */
  void beginStep(const Points& x, const Pose& X_WT_before, const Pose& X_WT, bool refresh);

  bool active() const override;

  /** Nodal depths of the last field; all NaN before the first; none of a membrane. */
  const std::vector<double>& depth() const;

 private:
  void collect(std::vector<ContactSample>& samples) override;
  DepthCurvature curvature(const ContactSample& sample) const override;
  void setStiffness(double pa_per_m) override;
  void exchangePlaces(StateArchive& archive) override;
  void forgetPlaces() override;
  void lagFriction(const Points& x, const Pose& X_WT_before, const Pose& X_WT, bool refresh);
  void lagPlaces(const Points& x, const Pose& X_WT_before, const Pose& X_WT, bool refresh);
  void select();

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace soft_tissue
