#pragma once

#include <memory>
#include <vector>

#include "soft_tissue_sim/base/hash.h"
#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/contact/contact_law.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/contact/tissue_body.h"
#include "soft_tissue_sim/energy/term.h"

namespace soft_tissue
{
class Friction;
struct DepthCurvature;

/** How contact of a pair is modelled. */
struct ContactOptions
{
  ContactLaw law = ContactLaw::pressure;
  bool segments = true;         ///< segment-in-object; false: point-in-object
  bool closest_feature = true;  ///< depth from the nearest boundary feature; false: interpolated
  bool lazy_field = true;       ///< march only as far as contacts read, and only when they do
  double stiffness_pa_per_m = 0.0;  ///< kappa, or the k of another law
  double friction = 0.0;            ///< Coulomb coefficient, >= 0
  double damping_s_per_m = 0.0;     ///< pressure over pressure per speed of approach, >= 0
};

/** Wall time of a contact's parts since the last call of takeTimes(), s. */
struct ContactTimes
{
  double field = 0.0;
  double detect = 0.0;
  double respond = 0.0;
};

/**
 * Penalty contact of one pair: the integral of 1/2 kappa d^2 dA over what of each surface is inside
 * the other, both directions averaged, and Coulomb friction.
 *
 * What kind of pair it is, and how a step begins, is for those derived to say.
 */
class ContactTerm : public EnergyTerm
{
 public:
  ~ContactTerm() override;

  /** False when nothing can touch during this step: value, gradient and Hessian are then zero. */
  virtual bool active() const = 0;

  /** Forgets what the steps before left: nodal depths, which are marched anew before they are next
   * read, whatever a step is told; stiffening; and what friction holds. */
  void forget();

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  /** Exact but for what the motion of clip points adds, and of the kinks of an interpolated depth;
   * its positive part is what a depth without curvature would give. */
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

  /** Length of the step that begins next, s; infinite where there is no time. */
  void setStep(double step_s);

  /** Takes another stiffness than that of the options. */
  void setBaseStiffness(double pa_per_m);
  /** Multiplies the options' stiffness from now on; 1 at first. */
  void setStiffening(double factor);
  double stiffening() const { return stiffening_; }

  /** The samples at x, world frame; valid until the next call of any member. */
  const std::vector<ContactSample>& samples(const Points& x);
  /** Largest depth of the samples at x, m. */
  double deepest(const Points& x);
  /** Largest depth that presses, see ContactSample::excess(), m. */
  double deepestExcess(const Points& x);
  /** Friction at x, where contacts were when the step began; valid until the next call of any
   * member. */
  const std::vector<FrictionForce>& frictionForces(const Points& x);

  /** Adds what the next step takes over from those before. */
  virtual void addTo(StateHash& hash) const;

  /**
   * Writes, or reads, all that later steps and samples at x depend on.
   * @param x  positions of the nodes, N x 3, m: where the last step ended
   * @throws Error on reading what does not fit
   */
  void exchange(StateArchive& archive, const Points& x);

  /** Wall times since the last call. */
  ContactTimes takeTimes();

 protected:
  /** @param bodies  those that can deform */
  ContactTerm(const ContactOptions& options, const std::vector<TissueBody>& bodies);

  /** Finds the samples where the bodies are now. */
  virtual void collect(std::vector<ContactSample>& samples) = 0;
  /** Of one of those samples. */
  virtual DepthCurvature curvature(const ContactSample& sample) const = 0;
  virtual void setStiffness(double pa_per_m) = 0;
  /** Has nodal depths marched anew, and what is near looked for, before they are next read. */
  virtual void forgetPlaces() = 0;
  /** Writes, or reads, what a step began with, and what was found in it. */
  virtual void exchangePlaces(StateArchive& archive) = 0;

  const ContactOptions& options() const { return options_; }
  Friction& friction() { return *friction_; }
  ContactTimes& times() { return times_; }
  /** Positions of what body k's surface numbers, m, where samples were or are being taken. */
  const Points& body(std::size_t k) const
  {
    return bodies_[k].points == nullptr ? nodes_[k] : points_[k];
  }
  void takeBodies(const Points& x);
  bool haveSamplesAt(const Points& x) const;
  void forgetSamples();

 private:
  ContactOptions options_;
  std::vector<TissueBody> bodies_;
  std::vector<Points> nodes_;   ///< of each body
  std::vector<Points> points_;  ///< of those that have TissueBody::points
  std::unique_ptr<Friction> friction_;
  double stiffening_ = 1.0;
  bool have_samples_ = false;
  std::vector<ContactSample> samples_;
  ContactTimes times_;
};

}  // namespace soft_tissue
