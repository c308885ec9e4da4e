#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "soft_root.h"
#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/** Constants of a triangle in its plane. */
struct StretchRest
{
  double inverse[2][2];  ///< of the rest edges (v0 v1), (v0 v2) as columns, 1/m
  double mu;             ///< volume times shear modulus, J
  double kappa;          ///< volume times E / (2 (1 - nu)), J
};

/** Deformation gradient of a triangle, and the normal c = f1 x f2 of length J. */
struct StretchState
{
  Vec3 f1, f2, c;
  double w;

  StretchState(const StretchRest& rest, const Vec3& x0, const Vec3& x1, const Vec3& x2)
  {
    const Vec3 d1 = x1 - x0, d2 = x2 - x0;
    f1 = rest.inverse[0][0] * d1 + rest.inverse[1][0] * d2;
    f2 = rest.inverse[0][1] * d1 + rest.inverse[1][1] * d2;
    c = f1.cross(f2);
    w = c.squaredNorm();
  }
};

/** mu/2 (|F|^2 - 2) - mu (j - 1) + kappa/2 (j - 1)^2, J. */
inline double stretchEnergy(const StretchRest& rest, const StretchState& f)
{
  const double more = softRoot(f.w).value - 1.0;
  return rest.mu * (0.5 * (f.f1.squaredNorm() + f.f2.squaredNorm() - 2.0) - more) +
         0.5 * rest.kappa * more * more;
}

/** Its derivative by the three nodes, N. */
inline void stretchForces(const StretchRest& rest, const StretchState& f, Vec3* gradient)
{
  const SoftRoot j = softRoot(f.w);
  const double pull = 2.0 * j.slope * (rest.kappa * (j.value - 1.0) - rest.mu);
  const Vec3 p1 = rest.mu * f.f1 + pull * f.f2.cross(f.c);
  const Vec3 p2 = rest.mu * f.f2 + pull * f.c.cross(f.f1);
  gradient[1] = rest.inverse[0][0] * p1 + rest.inverse[0][1] * p2;
  gradient[2] = rest.inverse[1][0] * p1 + rest.inverse[1][1] * p2;
  gradient[0] = -gradient[1] - gradient[2];
}

/** Principal directions: F = U diag(s1, s2) V^T, the third column of U the normal. */
struct PrincipalStretch
{
  Mat3 u;
  double s1, s2;        ///< s1 >= s2 >= 0
  double cosine, sine;  ///< V = [cosine, -sine; sine, cosine]
};

inline PrincipalStretch principalStretch(const StretchState& f)
{
  PrincipalStretch p;
  const double a = f.f1.squaredNorm(), b = f.f1.dot(f.f2), d = f.f2.squaredNorm();
  const double half = 0.5 * (a - d);
  const double radius = std::sqrt(half * half + b * b);
  const double cosine2 = radius > 0.0 ? half / radius : 1.0;
  // The larger of the two from the sum, the other from the sine: no digits are lost.
  const double larger = std::sqrt(0.5 * (1.0 + std::abs(cosine2)));
  const double smaller = radius > 0.0 ? 0.5 * std::abs(b) / (radius * larger) : 0.0;
  p.cosine = cosine2 >= 0.0 ? larger : smaller;
  p.sine = std::copysign(cosine2 >= 0.0 ? smaller : larger, b);
  const Vec3 longest = p.cosine * f.f1 + p.sine * f.f2;
  const double j = std::sqrt(f.w);
  p.s1 = longest.norm();
  p.s2 = p.s1 > 0.0 ? std::min(j / p.s1, p.s1) : 0.0;
  Vec3 u1 = Vec3::UnitX();
  if (p.s1 > 0.0)
  {
    u1 = longest / p.s1;
  }
  // Of a triangle as thin as rounding any normal will do.
  Vec3 n = u1.unitOrthogonal();
  if (j > 1e-12 * p.s1 * p.s1)
  {
    n = f.c - f.c.dot(u1) * u1;
    n.normalize();
  }
  p.u.col(0) = u1;
  p.u.col(1) = n.cross(u1);
  p.u.col(2) = n;
  return p;
}

/** [a b; b c] without its negative eigenvalues. */
inline void projectPair(double& a, double& b, double& c)
{
  const double mean = 0.5 * (a + c), half = 0.5 * (a - c);
  const double radius = std::sqrt(half * half + b * b);
  if (mean >= radius)
  {
    return;
  }
  const double high = std::max(mean + radius, 0.0);
  const double scale = radius > 0.0 ? 0.5 * high / radius : 0.0;
  a = 0.5 * high + scale * half;
  c = 0.5 * high - scale * half;
  b *= scale;
}

/**
 * Second derivative of stretchEnergy() by nodes 1 and 2, from the principal stretches: that of a
 * membrane has a pair of stretches, in-plane rotation and shear, and two tilts out of the plane.
 * @param k  blocks (1,1), (1,2), (2,2), N/m
 */
inline void stretchStiffness(const StretchRest& rest, const StretchState& f, bool positive, Mat3* k)
{
  const PrincipalStretch p = principalStretch(f);
  const SoftRoot r = softRoot(f.w);
  const double j = p.s1 * p.s2, stress = rest.kappa * (r.value - 1.0) - rest.mu;
  const double slope = 2.0 * j * r.slope;  // dj/dJ
  const double pull = 2.0 * stress * r.slope;
  const double pressure = pull * j;
  const double bulk =
      rest.kappa * slope * slope + stress * (2.0 * r.slope + 4.0 * j * j * r.curvature);
  double along = rest.mu + bulk * p.s2 * p.s2, both = pressure + bulk * j;
  double across = rest.mu + bulk * p.s1 * p.s1;
  double turn = rest.mu + pressure, shear = rest.mu - pressure;
  double tilt1 = rest.mu + pull * p.s2 * p.s2, tilt2 = rest.mu + pull * p.s1 * p.s1;
  if (positive)
  {
    projectPair(along, both, across);
    turn = std::max(turn, 0.0);
    shear = std::max(shear, 0.0);
    tilt1 = std::max(tilt1, 0.0);
    tilt2 = std::max(tilt2, 0.0);
  }
  const double sum = 0.5 * (shear + turn), difference = 0.5 * (shear - turn);
  double g[2][2];  // shape gradients of nodes 1 and 2 along V
  for (int i = 0; i < 2; ++i)
  {
    g[i][0] = p.cosine * rest.inverse[i][0] + p.sine * rest.inverse[i][1];
    g[i][1] = p.cosine * rest.inverse[i][1] - p.sine * rest.inverse[i][0];
  }
  constexpr int kRow[3] = {0, 0, 1}, kColumn[3] = {0, 1, 1};
  for (int block = 0; block < 3; ++block)
  {
    const double* a = g[kRow[block]];
    const double* b = g[kColumn[block]];
    const double in_plane[2][2] = {
        {along * a[0] * b[0] + sum * a[1] * b[1], both * a[0] * b[1] + difference * a[1] * b[0]},
        {both * a[1] * b[0] + difference * a[0] * b[1], across * a[1] * b[1] + sum * a[0] * b[0]}};
    const double out = tilt1 * a[0] * b[0] + tilt2 * a[1] * b[1];
    const Vec3 first = in_plane[0][0] * p.u.col(0) + in_plane[1][0] * p.u.col(1);
    const Vec3 second = in_plane[0][1] * p.u.col(0) + in_plane[1][1] * p.u.col(1);
    k[block].noalias() = first * p.u.col(0).transpose();
    k[block].noalias() += second * p.u.col(1).transpose();
    k[block].noalias() += (out * p.u.col(2)) * p.u.col(2).transpose();
  }
}

}  // namespace soft_tissue
