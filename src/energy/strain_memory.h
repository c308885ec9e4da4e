/**
 * What tets remember of their strain, as a law of Green's strain E = (F^T F - I) / 2. Included by
 * kernel files only (see pack.h).
 */
#pragma once

#include "law_forms.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** Where the six numbers of a symmetric matrix stand in it: xx, yy, zz, yz, xz, xy. */
constexpr int kSymmetric[6][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};

inline PackMat symmetric(const Pack* six)
{
  PackMat a;
  for (int k = 0; k < 6; ++k)
  {
    a.m[kSymmetric[k][0]][kSymmetric[k][1]] = a.m[kSymmetric[k][1]][kSymmetric[k][0]] = six[k];
  }
  return a;
}

inline PackMat greenStrain(const PackMat& f)
{
  Pack six[6];
  for (int k = 0; k < 6; ++k)
  {
    const int i = kSymmetric[k][0], j = kSymmetric[k][1];
    const Pack dot = f.m[0][i] * f.m[0][j] + f.m[1][i] * f.m[1][j] + f.m[2][i] * f.m[2][j];
    six[k] = 0.5 * (i == j ? dot - 1.0 : dot);
  }
  return symmetric(six);
}

/**
 * mu |E - E0|^2 + lambda/2 tr(E - E0)^2 + H : E. Constants: mu, lambda, six of E0 and six of H, of
 * each point of a tet.
 */
struct StrainMemory
{
  static constexpr Form kForm = Form::strain;
  static constexpr int kConstants = kMemoryConstants;

  /** Second Piola-Kirchhoff stress. */
  static PackMat secondStress(const PackMat& f, const Pack* c)
  {
    const PackMat e = greenStrain(f), e0 = symmetric(c + 2);
    PackMat s = symmetric(c + 8);
    const Pack trace =
        (e.m[0][0] - e0.m[0][0]) + (e.m[1][1] - e0.m[1][1]) + (e.m[2][2] - e0.m[2][2]);
    for (int k = 0; k < 9; ++k)
    {
      const int i = k / 3, j = k % 3;
      const Pack change = 2.0 * c[0] * (e.m[i][j] - e0.m[i][j]);
      s.m[i][j] += i == j ? change + c[1] * trace : change;
    }
    return s;
  }

  static Pack energy(const PackMat& f, const Pack* c)
  {
    const PackMat e = greenStrain(f), e0 = symmetric(c + 2), h = symmetric(c + 8);
    Pack squares = {}, trace = {}, linear = {};
    for (int k = 0; k < 9; ++k)
    {
      const int i = k / 3, j = k % 3;
      const Pack change = e.m[i][j] - e0.m[i][j];
      squares += change * change;
      linear += h.m[i][j] * e.m[i][j];
      trace += i == j ? change : Pack{};
    }
    return c[0] * squares + 0.5 * c[1] * trace * trace + linear;
  }

  static PackMat stress(const PackMat& f, const Pack* c)
  {
    const PackMat s = secondStress(f, c);
    PackMat p;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        p.m[i][j] = f.m[i][0] * s.m[0][j] + f.m[i][1] * s.m[1][j] + f.m[i][2] * s.m[2][j];
      }
    }
    return p;
  }
};

/** Second Piola-Kirchhoff stress F^-1 P of a law, with det F taken as kLeastMemoryVolume where it
 * is less: flat tets would have none. Of the linear law its stress. */
template <typename Material>
inline PackMat memorableStress(const PackMat& f, const Pack* c)
{
  const PackMat p = Material::stress(f, c);
  if constexpr (Material::kForm == Form::linear)
  {
    return p;
  }
  const PackMat cof = cofactor(f);
  const Pack inverse = 1.0 / max(determinant(f), splat(kLeastMemoryVolume));
  PackMat s;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      s.m[i][j] =
          inverse * (cof.m[0][i] * p.m[0][j] + cof.m[1][i] * p.m[1][j] + cof.m[2][i] * p.m[2][j]);
    }
  }
  return s;
}

/** What is remembered of a point: Green's strain of StrainMemory itself, a law's stress. */
template <typename Material>
inline void remember(const PackMat& f, const Pack* c, double* six)
{
  PackMat what;
  if constexpr (Material::kForm == Form::strain)
  {
    what = greenStrain(f);
  }
  else
  {
    what = memorableStress<Material>(f, c);
  }
  for (int k = 0; k < 6; ++k)
  {
    store(six + kTetLanes * k, what.m[kSymmetric[k][0]][kSymmetric[k][1]]);
  }
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
