/**
 * Signed singular values of 3 x 3 matrices, several at once. Included by kernel files only (see
 * pack.h).
 */
#pragma once

#include "pack.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
struct PackVec
{
  Pack v[3];
};

/** m[row][column]. */
struct PackMat
{
  Pack m[3][3];
};

inline Pack determinant(const PackMat& a)
{
  return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
         a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
         a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

/** Cofactor matrix: d det(A) / dA. */
inline PackMat cofactor(const PackMat& a)
{
  PackMat c;
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j)
    {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c.m[i][j] = a.m[i1][j1] * a.m[i2][j2] - a.m[i1][j2] * a.m[i2][j1];
    }
  }
  return c;
}

/** Rows of a times the transposed matrix of rows b. */
inline PackMat timesTransposed(const PackMat& a, const PackMat& b)
{
  PackMat r;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      r.m[i][j] = a.m[i][0] * b.m[j][0] + a.m[i][1] * b.m[j][1] + a.m[i][2] * b.m[j][2];
    }
  }
  return r;
}

inline Pack frobeniusSquared(const PackMat& a)
{
  Pack sum = a.m[0][0] * a.m[0][0];
  for (int k = 1; k < 9; ++k)
  {
    sum += a.m[k / 3][k % 3] * a.m[k / 3][k % 3];
  }
  return sum;
}

/** F = U diag(sigma) V^T with rotations U and V; sigma descending in size, only the last may be
 * negative. */
struct Svd
{
  PackMat u;
  Pack sigma[3];
  PackMat v;
};

/** Turns columns p and q of both matrices by the angle with this tangent. */
inline void rotateColumns(PackMat& a, int p, int q, Pack c, Pack s)
{
  for (int i = 0; i < 3; ++i)
  {
    const Pack ap = a.m[i][p], aq = a.m[i][q];
    a.m[i][p] = c * ap - s * aq;
    a.m[i][q] = s * ap + c * aq;
  }
}

inline Pack columnDot(const PackMat& a, int p, int q)
{
  return a.m[0][p] * a.m[0][q] + a.m[1][p] * a.m[1][q] + a.m[2][p] * a.m[2][q];
}

/** Where `swap`, exchanges columns p and q and turns one round, which keeps the determinant. */
inline void swapColumns(PackMat& a, int p, int q, Mask swap)
{
  for (int i = 0; i < 3; ++i)
  {
    const Pack ap = a.m[i][p], aq = a.m[i][q];
    a.m[i][p] = swap ? aq : ap;
    a.m[i][q] = swap ? -ap : aq;
  }
}

/** One-sided Jacobi rotations until all columns of F V are at right angles: relatively exact for
 * small sigma too. */
inline Svd signedSvd(const PackMat& f)
{
  constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  constexpr int kSortFirst[3] = {0, 1, 0};  // compare neighbours 0-1, 1-2, 0-1: sorted
  const Pack zero = {};
  Svd svd;
  PackMat b = f;
  for (int k = 0; k < 9; ++k)
  {
    svd.v.m[k / 3][k % 3] = splat(k % 4 == 0 ? 1.0 : 0.0);
  }
  for (int sweep = 0; sweep < 12; ++sweep)
  {
    Mask turned = {};
    for (const auto& pair : kPairs)
    {
      const int p = pair[0], q = pair[1];
      const Pack alpha = columnDot(b, p, p), beta = columnDot(b, q, q), gamma = columnDot(b, p, q);
      const Mask turn = gamma * gamma > 1e-30 * (alpha * beta);
      turned |= turn;
      const Pack twice = turn ? gamma + gamma : zero + 1.0;
      const Pack zeta = (beta - alpha) / twice;
      const Pack t = (zeta < 0.0 ? zero - 1.0 : zero + 1.0) / (abs(zeta) + sqrt(1.0 + zeta * zeta));
      const Pack c = turn ? 1.0 / sqrt(1.0 + t * t) : zero + 1.0;
      const Pack s = turn ? c * t : zero;
      rotateColumns(b, p, q, c, s);
      rotateColumns(svd.v, p, q, c, s);
    }
    if (!any(turned))
    {
      break;
    }
  }
  Pack norm[3];
  for (int i = 0; i < 3; ++i)
  {
    norm[i] = columnDot(b, i, i);
  }
  for (const int p : kSortFirst)
  {
    const int q = p + 1;
    const Mask swap = norm[p] < norm[q];
    swapColumns(b, p, q, swap);
    swapColumns(svd.v, p, q, swap);
    const Pack np = norm[p], nq = norm[q];
    norm[p] = swap ? nq : np;
    norm[q] = swap ? np : nq;
  }
  // U's columns: the first along b0, the second along what of b1 is at right angles to it, the
  // third fixed by both.
  const Pack s0 = sqrt(norm[0]);
  const Mask has0 = s0 > 1e-150;
  const Pack inv0 = 1.0 / (has0 ? s0 : zero + 1.0);
  PackVec u0, u1;
  for (int i = 0; i < 3; ++i)
  {
    u0.v[i] = has0 ? b.m[i][0] * inv0 : splat(i == 0 ? 1.0 : 0.0);
  }
  const Pack along = u0.v[0] * b.m[0][1] + u0.v[1] * b.m[1][1] + u0.v[2] * b.m[2][1];
  for (int i = 0; i < 3; ++i)
  {
    u1.v[i] = b.m[i][1] - along * u0.v[i];
  }
  Pack s1 = sqrt(u1.v[0] * u1.v[0] + u1.v[1] * u1.v[1] + u1.v[2] * u1.v[2]);
  const Mask has1 = s1 > 1e-15 * s0 && s1 > 1e-150;
  // A direction at right angles to u0, for matrices of rank one or none.
  const Mask flat = abs(u0.v[2]) > 0.5;
  PackVec other;
  other.v[0] = flat ? u0.v[2] : -u0.v[1];
  other.v[1] = flat ? zero : u0.v[0];
  other.v[2] = flat ? -u0.v[0] : zero;
  const Pack other_norm =
      sqrt(other.v[0] * other.v[0] + other.v[1] * other.v[1] + other.v[2] * other.v[2]);
  const Pack inv1 = 1.0 / (has1 ? s1 : other_norm);
  for (int i = 0; i < 3; ++i)
  {
    u1.v[i] = (has1 ? u1.v[i] : other.v[i]) * inv1;
    svd.u.m[i][0] = u0.v[i];
    svd.u.m[i][1] = u1.v[i];
  }
  for (int i = 0; i < 3; ++i)
  {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    svd.u.m[i][2] = u0.v[i1] * u1.v[i2] - u0.v[i2] * u1.v[i1];
  }
  svd.sigma[0] = s0;
  svd.sigma[1] = has1 ? s1 : zero;
  svd.sigma[2] = svd.u.m[0][2] * b.m[0][2] + svd.u.m[1][2] * b.m[1][2] + svd.u.m[2][2] * b.m[2][2];
  return svd;
}

/** Symmetric 3 x 3 matrices with their negative eigenvalues set to zero, in place; others keep
 * their bits. */
inline void projectSymmetric(PackMat& a)
{
  const Pack zero = {};
  const Pack minor = a.m[0][0] * a.m[1][1] - a.m[0][1] * a.m[0][1];
  const Mask good = a.m[0][0] > 0.0 && minor > 0.0 && determinant(a) > 0.0;
  if (!any(good == 0))
  {
    return;
  }
  constexpr int kPairs[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  PackMat d = a, v;
  for (int k = 0; k < 9; ++k)
  {
    v.m[k / 3][k % 3] = splat(k % 4 == 0 ? 1.0 : 0.0);
  }
  for (int sweep = 0; sweep < 12; ++sweep)
  {
    const Pack scale = frobeniusSquared(d);
    Mask turned = {};
    for (const auto& pair : kPairs)
    {
      const int p = pair[0], q = pair[1];
      const Pack off = d.m[p][q];
      const Mask turn = off * off > 1e-32 * scale;
      turned |= turn;
      const Pack zeta = (d.m[q][q] - d.m[p][p]) / (turn ? off + off : zero + 1.0);
      const Pack t = (zeta < 0.0 ? zero - 1.0 : zero + 1.0) / (abs(zeta) + sqrt(1.0 + zeta * zeta));
      const Pack c = turn ? 1.0 / sqrt(1.0 + t * t) : zero + 1.0;
      const Pack s = turn ? c * t : zero;
      rotateColumns(d, p, q, c, s);
      for (int j = 0; j < 3; ++j)
      {
        const Pack dp = d.m[p][j], dq = d.m[q][j];
        d.m[p][j] = c * dp - s * dq;
        d.m[q][j] = s * dp + c * dq;
      }
      rotateColumns(v, p, q, c, s);
    }
    if (!any(turned))
    {
      break;
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      Pack sum = zero;
      for (int k = 0; k < 3; ++k)
      {
        sum += max(d.m[k][k], zero) * v.m[i][k] * v.m[j][k];
      }
      a.m[i][j] = good ? a.m[i][j] : sum;
    }
  }
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
