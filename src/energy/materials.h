/**
 * The constitutive laws, several tets at once. Included by kernel files only (see pack.h).
 *
 * A law is isotropic: energy density and first Piola-Kirchhoff stress of F, and in principal
 * stretches s the second derivatives, from which one routine builds the projected stiffness for all
 * laws: hessian[i][j] = d2 psi / ds_i ds_j, difference[k] = (g_i - g_j) / (s_i - s_j),  sum[k] =
 * (g_i + g_j) / (s_i + s_j),  g = d psi / ds, the pairs (i, j) being (1,2), (0,2), (0,1) for k = 0,
 * 1, 2, in forms that stay finite where stretches meet.
 */
#pragma once

#include "svd3.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
struct PrincipalStiffness
{
  PackMat hessian;
  Pack difference[3];
  Pack sum[3];
};

/** Second derivatives of a law of I_C = |F|^2 and J = det F: P = m F + pressure cof(F),
 * dP = m dF + curvature (F : dF) F + volumetric (cof : dF) cof + pressure dcof. */
struct InvariantStiffness
{
  Pack m;
  Pack curvature;
  Pack volumetric;
  Pack pressure;
};

/** Stable neo-Hookean: mu/2 (I_C - 3) + lambda/2 (J - alpha)^2 - mu/2 log(I_C + 1), zero at rest.
 */
struct NeoHookean
{
  static constexpr bool kOfInvariants = true;

  /** mu, lambda, alpha of the law, and its energy density at F = I, so that small strains match E
   * and nu. */
  static void constants(double young_modulus, double poisson_ratio, double* c)
  {
    const double mu = young_modulus / (2.0 * (1.0 + poisson_ratio));
    const double lambda =
        young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
    c[0] = 4.0 / 3.0 * mu;
    c[1] = lambda + 5.0 / 6.0 * mu;
    c[2] = 1.0 + 0.75 * c[0] / c[1];
    c[3] = 0.5 * c[1] * (1.0 - c[2]) * (1.0 - c[2]) - 0.5 * c[0] * 1.3862943611198906;
  }

  static Pack energy(const PackMat& f, const Pack* c)
  {
    const Pack ic = frobeniusSquared(f);
    const Pack volumetric = determinant(f) - c[2];
    return 0.5 * c[0] * (ic - 3.0 - log(ic + 1.0)) + 0.5 * c[1] * volumetric * volumetric - c[3];
  }

  static PackMat stress(const PackMat& f, const Pack* c)
  {
    const Pack m = c[0] * (1.0 - 1.0 / (frobeniusSquared(f) + 1.0));
    const Pack pressure = c[1] * (determinant(f) - c[2]);
    PackMat p = cofactor(f);
    for (int k = 0; k < 9; ++k)
    {
      p.m[k / 3][k % 3] = m * f.m[k / 3][k % 3] + pressure * p.m[k / 3][k % 3];
    }
    return p;
  }

  static InvariantStiffness ofInvariants(const PackMat& f, const Pack* c)
  {
    const Pack inverse = 1.0 / (frobeniusSquared(f) + 1.0);
    return {c[0] * (1.0 - inverse), 2.0 * c[0] * inverse * inverse, c[1],
            c[1] * (determinant(f) - c[2])};
  }

  static PrincipalStiffness principal(const Pack* s, const Pack* c)
  {
    const Pack inverse = 1.0 / (s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + 1.0);
    const Pack m = c[0] * (1.0 - inverse);
    const Pack curvature = 2.0 * c[0] * inverse * inverse;
    const Pack pressure = c[1] * (s[0] * s[1] * s[2] - c[2]);
    const Pack dj[3] = {s[1] * s[2], s[0] * s[2], s[0] * s[1]};
    PrincipalStiffness k;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        const Pack shared = curvature * s[i] * s[j] + c[1] * dj[i] * dj[j];
        k.hessian.m[i][j] = shared + (i == j ? m : pressure * s[3 - i - j]);
      }
      k.difference[i] = m - pressure * s[i];
      k.sum[i] = m + pressure * s[i];
    }
    return k;
  }
};

/** Corotated: mu |S - I|^2 + lambda/2 tr(S - I)^2 with the polar stretch S (a reflection makes one
 * stretch negative). */
struct Corotated
{
  static constexpr bool kOfInvariants = false;

  static void constants(double young_modulus, double poisson_ratio, double* c)
  {
    c[0] = young_modulus / (2.0 * (1.0 + poisson_ratio));
    c[1] = young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
    c[2] = 0.0;
    c[3] = 0.0;
  }

  static Pack energy(const PackMat& f, const Pack* c)
  {
    const Svd svd = signedSvd(f);
    const Pack e0 = svd.sigma[0] - 1.0, e1 = svd.sigma[1] - 1.0, e2 = svd.sigma[2] - 1.0;
    const Pack trace = e0 + e1 + e2;
    return c[0] * (e0 * e0 + e1 * e1 + e2 * e2) + 0.5 * c[1] * trace * trace;
  }

  static PackMat stress(const PackMat& f, const Pack* c)
  {
    const Svd svd = signedSvd(f);
    const Pack trace = svd.sigma[0] + svd.sigma[1] + svd.sigma[2] - 3.0;
    const Pack pressure = c[1] * trace - 2.0 * c[0];
    PackMat p;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        const Pack r = svd.u.m[i][0] * svd.v.m[j][0] + svd.u.m[i][1] * svd.v.m[j][1] +
                       svd.u.m[i][2] * svd.v.m[j][2];
        p.m[i][j] = 2.0 * c[0] * f.m[i][j] + pressure * r;
      }
    }
    return p;
  }

  static PrincipalStiffness principal(const Pack* s, const Pack* c)
  {
    const Pack zero = {};
    const Pack spin = 2.0 * (c[1] * (s[0] + s[1] + s[2] - 3.0) - 2.0 * c[0]);
    PrincipalStiffness k;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        k.hessian.m[i][j] = i == j ? 2.0 * c[0] + c[1] : c[1] + zero;
      }
      // The law's rotation jumps where two stretches cancel: its stiffness there is cut off, not
      // infinite.
      const Pack pair = s[(i + 1) % 3] + s[(i + 2) % 3];
      k.difference[i] = 2.0 * c[0];
      k.sum[i] = 2.0 * c[0] + spin / max(pair, zero + 1e-6);
    }
    return k;
  }
};

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
