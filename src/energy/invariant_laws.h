/**
 * Laws of I_C = |F|^2 and J = det F: stiffness without singular values. Included by kernel files
 * only (see pack.h).
 */
#pragma once

#include "law_forms.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** Stable neo-Hookean: mu/2 (I_C - 3) + lambda/2 (J - alpha)^2 - mu/2 log(I_C + 1), zero at rest.
 */
struct NeoHookean : OfInvariants<NeoHookean>
{
  static constexpr double kTilt = 0.0;

  /** mu, lambda, alpha of the law, and its energy density at F = I, so that small strains match E
   * and nu. */
  static void constants(const LawParameters& of, double* c)
  {
    c[0] = 4.0 / 3.0 * of.mu;
    c[1] = of.lambda + 5.0 / 6.0 * of.mu;
    c[2] = 1.0 + 0.75 * c[0] / c[1];
    c[3] = 0.5 * c[1] * (1.0 - c[2]) * (1.0 - c[2]) - 0.5 * c[0] * 1.3862943611198906;
  }

  static Pack energyOf(Pack ic, Pack j, const Pack* c)
  {
    const Pack volumetric = j - c[2];
    return 0.5 * c[0] * (ic - 3.0 - log(ic + 1.0)) + 0.5 * c[1] * volumetric * volumetric - c[3];
  }

  static InvariantStiffness derivatives(Pack ic, Pack j, const Pack* c)
  {
    const Pack inverse = 1.0 / (ic + 1.0);
    return {c[0] * (1.0 - inverse), 2.0 * c[0] * inverse * inverse, c[1], c[1] * (j - c[2])};
  }
};

/**
 * The neo-Hookean solid of textbooks: mu/2 (I_C - 3) + h(J), h = -mu log J + lambda/2 log(J)^2 down
 * to J = kLeast, and from there on its quadratic continuation, as there is no log J below zero.
 */
struct NeoHookeanLog : OfInvariants<NeoHookeanLog>
{
  static constexpr double kTilt = 0.0;
  static constexpr double kLeast = kLeastLogVolume;

  static void constants(const LawParameters& of, double* c)
  {
    c[0] = of.mu;
    c[1] = of.lambda;
    c[2] = 0.0;
    c[3] = 0.0;
  }

  static Pack energyOf(Pack ic, Pack j, const Pack* c)
  {
    const Pack at = max(j, splat(kLeast));
    const Pack log_j = log(at), below = min(j - kLeast, Pack{});
    const Pack slope = (c[1] * log_j - c[0]) / at;
    const Pack h = log_j * (0.5 * c[1] * log_j - c[0]);
    return 0.5 * c[0] * (ic - 3.0) + h + below * (slope + 0.5 * below * bend(log_j, at, c));
  }

  static InvariantStiffness derivatives(Pack, Pack j, const Pack* c)
  {
    const Pack at = max(j, splat(kLeast));
    const Pack log_j = log(at), below = min(j - kLeast, Pack{});
    const Pack volumetric = bend(log_j, at, c);
    return {c[0], Pack{}, volumetric, (c[1] * log_j - c[0]) / at + below * volumetric};
  }

  /** What lambda weighs of h. */
  static VolumeEnergy volumeEnergy(Pack j)
  {
    const Pack at = max(j, splat(kLeast));
    const Pack log_j = log(at), below = min(j - kLeast, Pack{});
    const Pack slope = log_j / at, curvature = (1.0 - log_j) / (at * at);
    return {0.5 * log_j * log_j + below * (slope + 0.5 * below * curvature),
            slope + below * curvature, curvature};
  }

 private:
  /** h'' */
  static Pack bend(Pack log_j, Pack at, const Pack* c)
  {
    return (c[0] + c[1] * (1.0 - log_j)) / (at * at);
  }
};

/**
 * Exponential stiffening: mu/2b (exp(b Q) - 1) + (lambda + mu)/2 (J - 1)^2, Q = I_C - 2 J - 1,
 * which is I_C - 3 of Demiray's law where volume is kept, and has no stress at rest. Polyconvex.
 * Past b Q = kSteepest it goes on quadratically, so that nothing overflows.
 */
struct Exponential : OfInvariants<Exponential>
{
  static constexpr double kTilt = -1.0;  // dQ/dF = 2 (F - cof F)
  static constexpr double kSteepest = kSteepestExponent;

  static void constants(const LawParameters& of, double* c)
  {
    c[0] = of.mu;
    c[1] = of.lambda + of.mu;
    c[2] = of.stiffening;
    c[3] = 0.5 * of.mu / of.stiffening;
  }

  static Pack energyOf(Pack ic, Pack j, const Pack* c)
  {
    const Pack exponent = exponentOf(ic, j, c);
    const Pack grown = expMinusOne(within(exponent)), beyond = past(exponent);
    const Pack more = (grown + 1.0) * beyond * (1.0 + 0.5 * beyond);
    return c[3] * (grown + more) + 0.5 * c[1] * (j - 1.0) * (j - 1.0);
  }

  static InvariantStiffness derivatives(Pack ic, Pack j, const Pack* c)
  {
    const Pack exponent = exponentOf(ic, j, c);
    const Pack growth = c[0] * (expMinusOne(within(exponent)) + 1.0);
    const Pack m = growth * (1.0 + past(exponent));
    return {m, 2.0 * c[2] * growth, c[1], c[1] * (j - 1.0) - m};
  }

 private:
  static Pack exponentOf(Pack ic, Pack j, const Pack* c) { return c[2] * (ic - 2.0 * j - 1.0); }
  /** The part of it that is an exponent; far below zero nothing is left of the exponential. */
  static Pack within(Pack exponent) { return max(min(exponent, splat(kSteepest)), splat(-700.0)); }
  static Pack past(Pack exponent) { return max(exponent - kSteepest, Pack{}); }
};

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
