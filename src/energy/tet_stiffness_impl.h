/**
 * Element stiffness: the second derivative of V psi(F) as it is, and its nearest positive
 * semi-definite matrix. Included by kernel files only (see pack.h).
 */
#pragma once

#include "tet_lanes.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
inline void storeDiagonal(const PackMat& block, int node, Pack* out)
{
  Pack* place = out + diagonalBlockOffset(node);
  place[0] = block.m[0][0];
  place[1] = block.m[1][0];
  place[2] = block.m[2][0];
  place[3] = block.m[1][1];
  place[4] = block.m[2][1];
  place[5] = block.m[2][2];
}

/**
 * Stores the blocks of a tet given those of nodes 1, 2, 3: block(a, b) for 0 <= a <= b < 3 couples
 * nodes a + 1 and b + 1. Those of node 0 follow, as a common translation meets no resistance.
 */
template <typename Block>
inline void storeStiffness(const Block& blockOf, Index group, int lane, double* stiffness)
{
  Pack out[kTetStiffnessSize];
  PackMat row[3] = {};  // row sums of the blocks of nodes 1, 2, 3: minus the blocks with node 0
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      const PackMat block = blockOf(a, b);
      for (int i = 0; i < 3; ++i)
      {
        for (int j = 0; j < 3; ++j)
        {
          row[a].m[i][j] += block.m[i][j];
          if (b != a)
          {
            row[b].m[i][j] += block.m[j][i];
            out[offDiagonalBlockOffset(a + 1, b + 1) + 3 * j + i] = block.m[i][j];
          }
        }
      }
      if (a == b)
      {
        storeDiagonal(block, a + 1, out);
      }
    }
  }
  PackMat corner = {};
  for (int a = 0; a < 3; ++a)
  {
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        corner.m[i][j] += row[a].m[i][j];
        out[offDiagonalBlockOffset(0, a + 1) + 3 * j + i] = -row[a].m[j][i];
      }
    }
  }
  storeDiagonal(corner, 0, out);
  storeTransposed<kTetStiffnessSize>(out, group, lane, stiffness);
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

/**
 * Blocks of a law of the invariants I_C and J, without singular values: with q_a = F b_a and
 * r_a = cof(F) b_a for the shape gradient b_a,
 * K_ab / V = m (b_a . b_b) I + curvature q_a q_b^T + volumetric r_a r_b^T + pressure [F (b_a x
 * b_b)] where [w]_ij = e_ijk w_k.
 */
class InvariantBlocks
{
 public:
  InvariantBlocks(const Lanes& t, const InvariantStiffness& k)
      : k_(k),
        q_(timesTransposed(t.gradients, t.f)),
        r_(timesTransposed(t.gradients, cofactor(t.f))),
        metric_(timesTransposed(t.gradients, t.gradients)),
        axis_(timesTransposed(cofactor(t.gradients), t.f))
  {
    k_.m *= t.volume;
    k_.curvature *= t.volume;
    k_.volumetric *= t.volume;
    k_.pressure *= t.volume;
  }

  PackMat operator()(int a, int b) const
  {
    PackMat block;
    for (int i = 0; i < 3; ++i)
    {
      const Pack q = k_.curvature * q_.m[a][i], r = k_.volumetric * r_.m[a][i];
      for (int j = 0; j < 3; ++j)
      {
        block.m[i][j] = q * q_.m[b][j] + r * r_.m[b][j];
      }
    }
    const Pack m = k_.m * metric_.m[a][b];
    for (int i = 0; i < 3; ++i)
    {
      block.m[i][i] += m;
    }
    if (a != b)
    {
      // b_a x b_b is a row of the cofactor matrix of the gradients.
      const int c = 3 - a - b;
      const Pack p = (b - a + 3) % 3 == 1 ? k_.pressure : -k_.pressure;
      for (int i = 0; i < 3; ++i)
      {
        const int j = (i + 1) % 3, l = (i + 2) % 3;
        block.m[i][j] += p * axis_.m[c][l];
        block.m[j][i] -= p * axis_.m[c][l];
      }
    }
    return block;
  }

 private:
  InvariantStiffness k_;
  PackMat q_, r_, metric_, axis_;
};

/** Blocks of any isotropic law from its principal stretches; as they are, or projected. */
template <typename Material, bool kProjected>
class PrincipalBlocks
{
 public:
  explicit PrincipalBlocks(const Lanes& t) : svd_(signedSvd(t.f))
  {
    const Pack zero = {};
    PrincipalStiffness k = Material::principal(svd_.sigma, t.constants);
    if (kProjected)
    {
      projectSymmetric(k.hessian);
    }
    for (int i = 0; i < 3; ++i)
    {
      const Pack even = t.volume * (kProjected ? max(k.difference[i], zero) : k.difference[i]);
      const Pack odd = t.volume * (kProjected ? max(k.sum[i], zero) : k.sum[i]);
      same_[i] = 0.5 * (even + odd);
      cross_[i] = 0.5 * (even - odd);
      for (int j = 0; j < 3; ++j)
      {
        hessian_.m[i][j] = t.volume * k.hessian.m[i][j];
      }
    }
    for (int a = 0; a < 3; ++a)
    {
      for (int j = 0; j < 3; ++j)
      {
        gradients_.m[a][j] = t.gradients.m[a][0] * svd_.v.m[0][j] +
                             t.gradients.m[a][1] * svd_.v.m[1][j] +
                             t.gradients.m[a][2] * svd_.v.m[2][j];
      }
    }
  }

  PackMat operator()(int a, int b) const
  {
    const Pack* da = gradients_.m[a];
    const Pack* db = gradients_.m[b];
    PackMat k;  // in the frame of the left singular vectors
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3, l = (i + 2) % 3;
      k.m[i][i] =
          hessian_.m[i][i] * da[i] * db[i] + same_[l] * da[j] * db[j] + same_[j] * da[l] * db[l];
      k.m[i][j] = hessian_.m[i][j] * da[i] * db[j] + cross_[l] * da[j] * db[i];
      k.m[i][l] = hessian_.m[i][l] * da[i] * db[l] + cross_[j] * da[l] * db[i];
    }
    PackMat uk;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        uk.m[i][j] =
            svd_.u.m[i][0] * k.m[0][j] + svd_.u.m[i][1] * k.m[1][j] + svd_.u.m[i][2] * k.m[2][j];
      }
    }
    return timesTransposed(uk, svd_.u);
  }

 private:
  Svd svd_;
  PackMat hessian_;    ///< by the stretches
  PackMat gradients_;  ///< rows: shape gradients of nodes 1, 2, 3 in the right singular vectors
  // The 2 x 2 blocks that mix F_ij and F_ji: [[same, cross], [cross, same]].
  Pack same_[3];
  Pack cross_[3];
};

template <typename Material>
void tetStiffness(const TetGroups& groups, Index begin, Index end, const double* x,
                  double* stiffness)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    if constexpr (Material::kOfInvariants)
    {
      const InvariantBlocks blocks(t, Material::ofInvariants(t.f, t.constants));
      storeStiffness(blocks, group, lane, stiffness);
    }
    else
    {
      storeStiffness(PrincipalBlocks<Material, false>(t), group, lane, stiffness);
    }
  });
}

template <typename Material>
void tetProjectedStiffness(const TetGroups& groups, Index begin, Index end, const double* x,
                           double* stiffness)
{
  forLanes(groups, begin, end, x, [&](Index group, int lane, const Lanes& t) {
    storeStiffness(PrincipalBlocks<Material, true>(t), group, lane, stiffness);
  });
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
