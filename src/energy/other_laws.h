/**
 * Laws of the principal stretches, and the linear one. Included by kernel files only (see pack.h).
 */
#pragma once

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
  static constexpr Form kForm = Form::stretches;

  static Pack dilatation(const PackMat& f)
  {
    const Svd svd = signedSvd(f);
    return svd.sigma[0] + svd.sigma[1] + svd.sigma[2] - 3.0;
  }
  static PackMat dilatationGradient(const PackMat& f) { return rotation(signedSvd(f)); }

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
    const Pack pressure = Base::pressure(trace, c) - 2.0 * c[0];
    const PackMat r = rotation(svd);
    PackMat p;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        p.m[i][j] = 2.0 * c[0] * f.m[i][j] + pressure * r.m[i][j];
      }
    }
    return p;
  }

  static PrincipalStiffness principal(const Pack* s, const Pack* c)
  {
    const Pack zero = {};
    const Pack spin = 2.0 * (Base::pressure(s[0] + s[1] + s[2] - 3.0, c) - 2.0 * c[0]);
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

 private:
  static PackMat rotation(const Svd& svd)
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
