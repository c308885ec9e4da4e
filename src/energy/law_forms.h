/**
 * What a constitutive law tells of itself, and what follows from it. Included by kernel files only
 * (see pack.h).
 *
 * A law is a struct of static functions: energy density and first Piola-Kirchhoff stress of F,
 * stressAndEnergy() if both at once cost less, and what its form asks for.
 */
#pragma once

#include <type_traits>

#include "soft_tissue_sim/energy/tet_kernels.h"
#include "svd3.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** How a law's second derivative is made. */
enum class Form
{
  invariants,  ///< from InvariantStiffness where it is not projected, else from the stretches
  stretches,   ///< from PrincipalStiffness
  rotation,    ///< from the polar decomposition where it is not projected, else from the stretches
  linear,      ///< from Lame parameters: it does not depend on F
  strain,      ///< of StrainMemory, which is no law by itself
};

template <typename Law, typename = void>
constexpr bool kBothAtOnce = false;
template <typename Law>
constexpr bool kBothAtOnce<Law, std::void_t<decltype(Law::stressAndEnergy)>> = true;

/** A law's stress, and its energy density. */
template <typename Law>
SOFT_TISSUE_INLINE PackMat stressAndEnergy(const PackMat& f, const Pack* c, Pack& energy)
{
  if constexpr (kBothAtOnce<Law>)
  {
    return Law::stressAndEnergy(f, c, energy);
  }
  else
  {
    energy = Law::energy(f, c);
    return Law::stress(f, c);
  }
}

/**
 * Second derivatives of an isotropic law in principal stretches s, from which one routine builds
 * the projected stiffness for all laws: hessian[i][j] = d2 psi / ds_i ds_j, difference[k] = (g_i -
 * g_j) / (s_i - s_j),  sum[k] = (g_i + g_j) / (s_i + s_j),  g = d psi / ds, the pairs (i, j) being
 * (1,2), (0,2), (0,1) for k = 0, 1, 2, in forms that stay finite where stretches meet.
 */
struct PrincipalStiffness
{
  PackMat hessian;
  Pack difference[3];
  Pack sum[3];
};

/** First and second derivatives of a law of I_C = |F|^2 and J = det F: with G = F + tilt cof(F) of
 * the law's constant tilt, P = m F + pressure cof(F), and dP = m dF + curvature (G : dF) G +
 * volumetric (cof : dF) cof + pressure dcof. */
struct InvariantStiffness
{
  Pack m;
  Pack curvature;
  Pack volumetric;
  Pack pressure;
};

/** The part of a law that lambda weighs, as a function of its dilatation, and two derivatives. */
struct VolumeEnergy
{
  Pack value;
  Pack slope;
  Pack curvature;
};

/** That of laws whose lambda weighs half the square of a dilatation. */
inline VolumeEnergy halfSquare(Pack dilatation)
{
  return {0.5 * dilatation * dilatation, dilatation, splat(1.0)};
}

/**
 * What follows from a law's energyOf(I_C, J) and its derivatives(I_C, J).
 *
 * Every law's energy is one at lambda = 0 plus lambda times volumeEnergy(dilatation(F)). So a
 * dilatation can be taken of more than one tet, see WithPressure.
 */
template <typename Law>
struct OfInvariants
{
  static constexpr Form kForm = Form::invariants;
  static constexpr int kConstants = kMaterialConstants;

  static Pack dilatation(const PackMat& f) { return determinant(f); }
  static PackMat dilatationGradient(const PackMat& f) { return cofactor(f); }
  static VolumeEnergy volumeEnergy(Pack j) { return halfSquare(j - 1.0); }

  static Pack energy(const PackMat& f, const Pack* c)
  {
    return Law::energyOf(frobeniusSquared(f), determinant(f), c);
  }

  static PackMat stress(const PackMat& f, const Pack* c)
  {
    const InvariantStiffness k = stiffness(f, c);
    PackMat p = cofactor(f);
    for (int n = 0; n < 9; ++n)
    {
      p.m[n / 3][n % 3] = k.m * f.m[n / 3][n % 3] + k.pressure * p.m[n / 3][n % 3];
    }
    return p;
  }

  static InvariantStiffness stiffness(const PackMat& f, const Pack* c)
  {
    return Law::derivatives(frobeniusSquared(f), determinant(f), c);
  }

  static PrincipalStiffness principal(const Pack* s, const Pack* c)
  {
    const InvariantStiffness k =
        Law::derivatives(s[0] * s[0] + s[1] * s[1] + s[2] * s[2], s[0] * s[1] * s[2], c);
    const Pack dj[3] = {s[1] * s[2], s[0] * s[2], s[0] * s[1]};
    Pack g[3];
    for (int i = 0; i < 3; ++i)
    {
      g[i] = Law::kTilt != 0.0 ? s[i] + Law::kTilt * dj[i] : s[i];
    }
    PrincipalStiffness p;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        const Pack shared = k.curvature * g[i] * g[j] + k.volumetric * dj[i] * dj[j];
        p.hessian.m[i][j] = shared + (i == j ? k.m : k.pressure * s[3 - i - j]);
      }
      p.difference[i] = k.m - k.pressure * s[i];
      p.sum[i] = k.m + k.pressure * s[i];
    }
    return p;
  }
};

/** A law of the invariants with one more constant: a pressure that acts on the dilatation, which
 * the energy leaves out. */
template <typename Law>
struct WithPressure : OfInvariants<WithPressure<Law>>
{
  static constexpr double kTilt = Law::kTilt;
  static constexpr int kConstants = kMaterialConstants + 1;

  static VolumeEnergy volumeEnergy(Pack j) { return Law::volumeEnergy(j); }
  static void constants(const LawParameters& of, double* c) { Law::constants(of, c); }
  static Pack energyOf(Pack ic, Pack j, const Pack* c) { return Law::energyOf(ic, j, c); }

  static InvariantStiffness derivatives(Pack ic, Pack j, const Pack* c)
  {
    InvariantStiffness k = Law::derivatives(ic, j, c);
    k.pressure += c[kMaterialConstants];
    return k;
  }
};

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
