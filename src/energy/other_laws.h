/**
 * Laws of the principal stretches, and the linear one. Included by kernel files only (see pack.h).
 */
#pragma once

#include "polar3.h"
#include "strain_memory.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/** The constants of a law that takes the Lame parameters as they are, and its pressure, the
 * derivative of its energy by the dilatation. */
struct OfLame
{
  static constexpr int kConstants = kMaterialConstants;

  static void constants(const LawParameters& of, double* c)
  {
    c[0] = of.mu;
    c[1] = of.lambda;
    c[2] = 0.0;
    c[3] = 0.0;
  }

  static Pack pressure(Pack dilatation, const Pack* c) { return c[1] * dilatation; }
  static VolumeEnergy volumeEnergy(Pack dilatation) { return halfSquare(dilatation); }
};

/** The same with one more constant: a pressure more, which the energy leaves out. */
struct OfLameAndPressure : OfLame
{
  static constexpr int kConstants = kMaterialConstants + 1;

  static Pack pressure(Pack dilatation, const Pack* c)
  {
    return c[1] * dilatation + c[kMaterialConstants];
  }
};

/** Corotated: mu |S - I|^2 + lambda/2 tr(S - I)^2 with the polar stretch S (a reflection makes one
 * stretch negative). */
template <typename Base>
struct CorotatedLaw : Base
{
  static constexpr Form kForm = Form::rotation;

  /** Sum of two stretches below which the stiffness is cut off. */
  static constexpr double kLeastPair = 1e-6;

  static Pack dilatation(const PackMat& f) { return polar(f).trace - 3.0; }
  static PackMat dilatationGradient(const PackMat& f) { return polar(f).rotation; }

  static Pack energy(const PackMat& f, const Pack* c) { return energyOf(f, polar(f), c); }
  static PackMat stress(const PackMat& f, const Pack* c) { return stressOf(f, polar(f), c); }
  /** Both at once, for the decomposition is most of either. */
  static PackMat stressAndEnergy(const PackMat& f, const Pack* c, Pack& energy)
  {
    const Polar polar_f = polar(f);
    energy = energyOf(f, polar_f, c);
    return stressOf(f, polar_f, c);
  }

  /** Factor of R in the stress 2 mu F + tension R. */
  static Pack tension(Pack trace, const Pack* c)
  {
    return Base::pressure(trace - 3.0, c) - 2.0 * c[0];
  }

  static PrincipalStiffness principal(const Pack* s, const Pack* c)
  {
    const Pack zero = {};
    const Pack spin = 2.0 * tension(s[0] + s[1] + s[2], c);
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
      k.sum[i] = 2.0 * c[0] + spin / max(pair, zero + kLeastPair);
    }
    return k;
  }

 private:
  static Pack energyOf(const PackMat& f, const Polar& polar_f, const Pack* c)
  {
    const Pack trace = polar_f.trace - 3.0;
    Pack squares = {};
    for (int k = 0; k < 9; ++k)
    {
      const Pack apart = f.m[k / 3][k % 3] - polar_f.rotation.m[k / 3][k % 3];
      squares += apart * apart;
    }
    return c[0] * squares + 0.5 * c[1] * trace * trace;
  }

  static PackMat stressOf(const PackMat& f, const Polar& polar_f, const Pack* c)
  {
    const Pack pressure = Base::pressure(polar_f.trace - 3.0, c);
    PackMat p;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        const Pack r = polar_f.rotation.m[i][j];
        p.m[i][j] = 2.0 * c[0] * (f.m[i][j] - r) + pressure * r;
      }
    }
    return p;
  }
};

/** St Venant-Kirchhoff: mu |E|^2 + lambda/2 tr(E)^2 with Green's strain E = (F^T F - I) / 2. */
template <typename Base>
struct StVenantKirchhoffLaw : Base
{
  static constexpr Form kForm = Form::stretches;

  static Pack dilatation(const PackMat& f) { return 0.5 * (frobeniusSquared(f) - 3.0); }
  static PackMat dilatationGradient(const PackMat& f) { return f; }

  static Pack energy(const PackMat& f, const Pack* c)
  {
    const PackMat e = greenStrain(f);
    const Pack trace = e.m[0][0] + e.m[1][1] + e.m[2][2];
    return c[0] * frobeniusSquared(e) + 0.5 * c[1] * trace * trace;
  }

  static PackMat stress(const PackMat& f, const Pack* c)
  {
    const PackMat e = greenStrain(f);
    const Pack pressure = Base::pressure(e.m[0][0] + e.m[1][1] + e.m[2][2], c);
    PackMat p;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        p.m[i][j] =
            2.0 * c[0] * (f.m[i][0] * e.m[0][j] + f.m[i][1] * e.m[1][j] + f.m[i][2] * e.m[2][j]) +
            pressure * f.m[i][j];
      }
    }
    return p;
  }

  static PrincipalStiffness principal(const Pack* s, const Pack* c)
  {
    const Pack squares[3] = {s[0] * s[0], s[1] * s[1], s[2] * s[2]};
    const Pack trace = 0.5 * (squares[0] + squares[1] + squares[2] - 3.0);
    const Pack rest = Base::pressure(trace, c) - c[0];
    PrincipalStiffness k;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        k.hessian.m[i][j] = i == j ? (3.0 * c[0] + c[1]) * squares[i] + rest : c[1] * s[i] * s[j];
      }
      const int a = (i + 1) % 3, b = (i + 2) % 3;
      k.difference[i] = c[0] * (squares[a] + s[a] * s[b] + squares[b]) + rest;
      k.sum[i] = c[0] * (squares[a] - s[a] * s[b] + squares[b]) + rest;
    }
    return k;
  }
};

/** Linear: mu |e|^2 + lambda/2 tr(e)^2 with e = (F + F^T) / 2 - I. A rotation strains it. */
template <typename Base>
struct LinearLaw : Base
{
  static constexpr Form kForm = Form::linear;

  static Pack dilatation(const PackMat& f) { return f.m[0][0] + f.m[1][1] + f.m[2][2] - 3.0; }
  static PackMat dilatationGradient(const PackMat&)
  {
    PackMat one;
    for (int k = 0; k < 9; ++k)
    {
      one.m[k / 3][k % 3] = splat(k % 4 == 0 ? 1.0 : 0.0);
    }
    return one;
  }

  static Pack energy(const PackMat& f, const Pack* c)
  {
    const PackMat e = smallStrain(f);
    const Pack trace = e.m[0][0] + e.m[1][1] + e.m[2][2];
    return c[0] * frobeniusSquared(e) + 0.5 * c[1] * trace * trace;
  }

  static PackMat stress(const PackMat& f, const Pack* c)
  {
    PackMat p = smallStrain(f);
    const Pack pressure = Base::pressure(p.m[0][0] + p.m[1][1] + p.m[2][2], c);
    for (int k = 0; k < 9; ++k)
    {
      const Pack shear = 2.0 * c[0] * p.m[k / 3][k % 3];
      p.m[k / 3][k % 3] = k % 4 == 0 ? shear + pressure : shear;
    }
    return p;
  }

 private:
  static PackMat smallStrain(const PackMat& f)
  {
    PackMat e;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = i; j < 3; ++j)
      {
        e.m[i][j] = e.m[j][i] = i == j ? f.m[i][i] - 1.0 : 0.5 * (f.m[i][j] + f.m[j][i]);
      }
    }
    return e;
  }
};

using Corotated = CorotatedLaw<OfLame>;
using StVenantKirchhoff = StVenantKirchhoffLaw<OfLame>;
using Linear = LinearLaw<OfLame>;

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
