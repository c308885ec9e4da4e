/**
 * Polar decompositions of 3 x 3 matrices, several at once. Included by kernel files only (see
 * pack.h).
 */
#pragma once

#include "svd3.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** F = R S with the rotation R that is nearest to F. */
struct Polar
{
  PackMat rotation;
  Pack trace;  ///< of S
  Mask clear;  ///< all other rotations are much farther
};

inline PackMat rotationOf(const Svd& svd)
{
  PackMat r;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      r.m[i][j] = svd.u.m[i][0] * svd.v.m[j][0] + svd.u.m[i][1] * svd.v.m[j][1] +
                  svd.u.m[i][2] * svd.v.m[j][2];
    }
  }
  return r;
}

/**
 * By the trace t of S, the largest root of a quartic in the invariants of F, and R = dt / dF; by
 * singular values where another rotation is nearly as near, so that R turns fast.
 * Source: Lin, Chitalu, Komura, Isotropic ARAP energy using Cauchy-Green invariants, ACM Trans.
 * Graph. 41 (2022).
 */
inline Polar polar(const PackMat& f)
{
  const PackMat cof = cofactor(f);
  const Pack squares = frobeniusSquared(f), areas = frobeniusSquared(cof);
  const Pack det = f.m[0][0] * cof.m[0][0] + f.m[0][1] * cof.m[0][1] + f.m[0][2] * cof.m[0][2];
  // With the stretches s: t = s0 + s1 + s2 and g = s0 s1 + s1 s2 + s2 s0 are such that
  // t^2 = |F|^2 + 2 g and g^2 = |cof F|^2 + 2 det F t. Newton's method comes down from above.
  Polar result;
  Pack& t = result.trace;
  t = sqrt(3.0 * squares);
  Pack slope = {};
  Mask moving = squares > 0.0;
  for (int i = 0; i < 40 && any(moving); ++i)
  {
    const Pack g = 0.5 * (t * t - squares);
    slope = 2.0 * (g * t - det);
    const Pack step = (g * g - areas - 2.0 * (det * t)) / slope;
    moving = moving & (step > 2e-16 * t);
    t = moving ? t - step : t;
  }
  slope = (t * t - squares) * t - 2.0 * det;
  const Mask good = slope > 0.02 * (t * t * t) && squares > 1e-70 && squares < 1e70;
  result.clear = good;
  const Pack inverse = 1.0 / slope, of_f = (t * t + squares) * inverse, of_cof = 2.0 * t * inverse;
  PackMat c;  // F^T F
  for (int i = 0; i < 3; ++i)
  {
    for (int j = i; j < 3; ++j)
    {
      c.m[i][j] = c.m[j][i] = columnDot(f, i, j);
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const Pack fc = f.m[i][0] * c.m[0][j] + f.m[i][1] * c.m[1][j] + f.m[i][2] * c.m[2][j];
      result.rotation.m[i][j] = of_f * f.m[i][j] + of_cof * cof.m[i][j] - (2.0 * inverse) * fc;
    }
  }
  if (any(good == 0))
  {
    const Svd svd = signedSvd(f);
    const PackMat r = rotationOf(svd);
    t = good ? t : svd.sigma[0] + svd.sigma[1] + svd.sigma[2];
    for (int k = 0; k < 9; ++k)
    {
      Pack& entry = result.rotation.m[k / 3][k % 3];
      entry = good ? entry : r.m[k / 3][k % 3];
    }
  }
  return result;
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
