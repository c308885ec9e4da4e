#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "soft_tissue_sim/base/hash.h"
#include "soft_tissue_sim/base/state_archive.h"
#include "soft_tissue_sim/base/types.h"
#include "soft_tissue_sim/contact/contact_sample.h"
#include "soft_tissue_sim/energy/block_matrix.h"

namespace soft_tissue
{
/** Where two bodies press on each other when a step begins, and what sticking would mean there. */
struct Grip
{
  std::uint64_t place = 0;  ///< of the contact, the same from step to step
  Vec3 normal;              ///< unit
  double press = 0.0;       ///< N along it
  int count = 0;
  /** With these weights of its nodes the point of the second body, less that of the first; the
   * former alone where the first is a tool. */
  std::array<Index, ContactSample::kMaxNodes> node{};
  std::array<double, ContactSample::kMaxNodes> weight{};
  Vec3 stuck_at;  ///< what those weights give at the end of the step if nothing moves on, m
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
 * What two bodies in contact lose energy by: Coulomb friction, as a potential of how far one slides
 * along the other, and damping, as one of how far they come nearer.
 *
 * Where it acts, how hard both press and along which plane is that of the step's start. Up to a
 * stick length the force grows smoothly with the slip, beyond it is Coulomb's. What has slipped
 * less stays slipped from step to step, so a load is held without creeping. The potential is
 * convex.
 *
 * Damping adds to a pressure its share per approach speed; bodies that part feel none, so contact
 * never pulls.
 *
 * Source: [Li2020] section 5, the smoothed and lagged friction of incremental potential contact,
 * which has no memory. [Hunt1975], whose damping acts both ways.
 */
class Friction
{
 public:
  /** @param coefficient  of Coulomb  @param damping  share of the pressure per speed, s/m */
  Friction(double coefficient, double damping) : coefficient_(coefficient), damping_(damping) {}

  bool acts() const { return coefficient_ > 0.0 || damping_ > 0.0; }

  /** Length of the steps that begin from now on, s; infinite where there is no time. */
  void setStep(double step_s) { step_s_ = step_s; }

  /** Begins a step at x, where the last one ended. */
  void begin(const Points& x);
  /** Adds a grip, by ascending places; it goes on with what was slipped at its place. */
  void add(Grip grip);
  /** Adds all slips. */
  void addTo(StateHash& hash) const;
  /** Writes, or reads, all slips. */
  void exchange(StateArchive& archive);
  /** Forgets all slips. */
  void forget();

  double value(const Points& x) const;
  void addGradient(const Points& x, Points& gradient) const;
  /** Exact, and never indefinite. */
  void addHessian(const Points& x, BlockMatrix& hessian) const;

  /** All forces at x. */
  const std::vector<FrictionForce>& forcesAt(const Points& x);

 private:
  /** How far a place had slipped, in stick lengths, at most 1. */
  struct Slipped
  {
    std::uint64_t place;
    Vec3 by;
  };
  double forcePerSlip(const Grip& grip, double slip) const;
  double forcePerApproach(const Grip& grip) const;
  Vec3 forceOf(const Grip& grip, const Points& x) const;

  double coefficient_, damping_;
  double step_s_ = std::numeric_limits<double>::infinity();
  std::vector<Grip> grips_;
  std::vector<Slipped> slipped_;  ///< when the step began, by ascending places
  std::size_t next_slipped_ = 0;  ///< the first that no grip has come past
  std::vector<FrictionForce> forces_;
};

/** Calls visit(sample, place) for those samples that press, with a place of their own each. */
template <typename Visit>
void forEachPress(const std::vector<ContactSample>& samples, const Visit& visit)
{
  std::uint64_t last = 0, rank = 0;
  for (const ContactSample& sample : samples)
  {
    const std::uint64_t element = (static_cast<std::uint64_t>(sample.side < 0) << 62) |
                                  (static_cast<std::uint64_t>(sample.element) << 24);
    rank = element == last ? rank + 1 : 0;
    last = element;
    if (sample.stiffness_area > 0.0 && sample.force > 0.0)
    {
      visit(sample, element | rank);
    }
  }
}

}  // namespace soft_tissue
