#pragma once

#include <cstdint>
#include <memory>

#include "soft_tissue_sim/contact/contact_term.h"
#include "soft_tissue_sim/contact/tissue_body.h"
#include "soft_tissue_sim/field/distance_field.h"

namespace soft_tissue
{
/**
 * Contact of two tissues, or of one with itself: the surface of each in the depth of the other. A
 * membrane, which has no depth, can only be the first of two: its surface counts whole.
 *
 * Of one body, an element of the surface can't be in tets that it shares a node with. Forces and
 * moments of both sum to zero, those of friction up to how far things slide in a step.
 */
class TissueContact : public ContactTerm
{
 public:
  /** A tissue and its field, for this contact alone; a membrane has none. */
  struct Side
  {
    TissueBody body;
    std::unique_ptr<DistanceField> field;
  };

  /** @throws Error if the second is a membrane */
  TissueContact(Side first, Side second, const ContactOptions& options);
  /** Of a body with itself; @throws Error unless it has TissueBody::rest */
  TissueContact(Side self, const ContactOptions& options);
  ~TissueContact() override;

  /**
   * Takes the state a step starts from.
   * @param x        positions at the start of the step
   * @param towards  where bodies go to if nothing stops them: what is near there is looked for
   * @param refresh  march the nodal depths anew on x; false keeps those there are
   */
  void beginStep(const Points& x, const Points& towards, bool refresh);

  bool active() const override;

  /** Depth that presses nothing from now on, m: lowered step by step it pushes bodies that began in
   * each other apart as slowly as one likes. */
  void setAllowance(double depth_m);

 private:
  void collect(std::vector<ContactSample>& samples) override;
  DepthCurvature curvature(const ContactSample& sample) const override;
  void setStiffness(double pa_per_m) override;
  void exchangePlaces(StateArchive& archive) override;
  void forgetPlaces() override;
  void lagFriction(const Points& x, bool refresh);
  void lagPlaces(const Points& x, const Points& towards, bool refresh);
  void beginSides(bool refresh);
  double motionSinceLook() const;
  double marginFor(double ahead, double room) const;
  double shortEdges() const;
  bool haveCandidates() const;
  void lookAround(double margin);
  void lookAgain();
  void addGrip(const ContactSample& sample, std::uint64_t place, const Points& x);

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace soft_tissue
