#pragma once

#include <vector>

#include "soft_tissue_sim/energy/elasticity.h"

namespace soft_tissue
{
/**
 * What of an elastic body resists to being deformed fast, as a potential of each step's end.
 *
 * Damping: the stress of Hooke's law, at the body's small-strain stiffness, for the change of
 * Green's strain over the step, times damping over its length. Relaxation: the law's stress S(E)
 * becomes S + sum of h_i, where h_i follows each change of S by its relative modulus g_i and decays
 * with its time t_i; S is taken to change evenly within a step, for which the sum is exact:
 * h_i(end) = exp(-h / t_i) h_i + g_i a_i (S(end) - S),  a_i = (1 - exp(-h / t_i)) t_i / h.
 * So the end of a step minimises the law's energy times 1 + sum of g_i a_i, plus a constant stress
 * times E. Stresses are those of the second Piola-Kirchhoff kind: a turned body neither feels nor
 * forgets anything. Source: [Taylor1970]
 */
class Viscosity : public TetTerm
{
 public:
  /**
   * @param law         of the body; must outlive this, and is made stiffer by steps
   * @param parameters  M, as the law has them
   */
  Viscosity(Elasticity& law, const std::vector<TetStiffnessParameters>& parameters,
            ViscosityParameters viscosity);

  /** A step of `step` seconds begins with nodes at x; it may begin anew. */
  void beginStep(const Points& x, double step);
  /** It has ended, with nodes at x. */
  void endStep(const Points& x);
  /** Nothing has ever happened to the body. */
  void forget();

  /** All it remembers from step to step. */
  const std::vector<double>& memory() const { return memory_; }
  void setMemory(const std::vector<double>& memory) { memory_ = memory; }

 private:
  void setDamping(const Points& x, double step);
  void setRelaxation(double step);

  Elasticity& law_;
  ViscosityParameters viscosity_;
  std::vector<double> lame_;             ///< [group][2][8]: mu and lambda, times damping
  std::vector<double> decays_, shares_;  ///< per branch, of the running step: exp(-h / t), g a
  std::vector<double> strain_;           ///< [group][point][6][8], of the step's start
  std::vector<double> stress_;           ///< the same of the law, at its end
  /** [branch][group][point][6][8] of h_i, and then the law's stress, as the last step ended. */
  std::vector<double> memory_;
};

}  // namespace soft_tissue
