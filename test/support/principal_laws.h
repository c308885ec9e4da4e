#pragma once

#include <array>
#include <cmath>

#include "soft_tissue_sim/energy/material.h"

namespace soft_tissue::test
{
/** Nominal stresses of F = diag(s), from the laws' energies as docs/methods.md writes them, Pa. */
inline std::array<double, 3> principalStresses(MaterialModel model,
                                               const TetStiffnessParameters& parameters,
                                               const std::array<double, 3>& s)
{
  const Lame lame = lameFrom(parameters.young_modulus, parameters.poisson_ratio);
  const double mu = lame.mu, lambda = lame.lambda, b = parameters.stiffening;
  const double j = s[0] * s[1] * s[2];
  const double i = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
  std::array<double, 3> p;
  for (int k = 0; k < 3; ++k)
  {
    const double dj = j / s[k];
    switch (model)
    {
      case MaterialModel::neo_hookean: {
        const double a = 4.0 / 3.0 * mu, bulk = lambda + 5.0 / 6.0 * mu;
        p[k] = a * (1.0 - 1.0 / (i + 1.0)) * s[k] + bulk * (j - 1.0 - 0.75 * a / bulk) * dj;
        break;
      }
      case MaterialModel::neo_hookean_log:
        p[k] = mu * s[k] + (lambda * std::log(j) - mu) / s[k];
        break;
      case MaterialModel::exponential:
        p[k] =
            mu * std::exp(b * (i - 2.0 * j - 1.0)) * (s[k] - dj) + (lambda + mu) * (j - 1.0) * dj;
        break;
      case MaterialModel::st_venant_kirchhoff:
        p[k] = s[k] * (mu * (s[k] * s[k] - 1.0) + 0.5 * lambda * (i - 3.0));
        break;
      default:
        p[k] = 2.0 * mu * (s[k] - 1.0) + lambda * (s[0] + s[1] + s[2] - 3.0);
    }
  }
  return p;
}

/** Uniaxial stress at a stretch. */
struct Uniaxial
{
  double stretch;
  double lateral;
  double stress;  ///< nominal, Pa
};

/** The lateral stretch at which nothing pulls at the sides, by halving. */
inline Uniaxial uniaxial(MaterialModel model, const TetStiffnessParameters& parameters, double s)
{
  double low = 0.2, high = 3.0;
  for (int k = 0; k < 100; ++k)
  {
    const double middle = 0.5 * (low + high);
    (principalStresses(model, parameters, {s, middle, middle})[1] < 0.0 ? low : high) = middle;
  }
  return {s, low, principalStresses(model, parameters, {s, low, low})[0]};
}

}  // namespace soft_tissue::test
