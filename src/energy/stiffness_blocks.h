/**
 * The second derivative of V psi(F) between linear shape functions, as it is and its nearest
 * positive semi-definite matrix: what all tets are made of. Included by kernel files only (see
 * pack.h).
 */
#pragma once

#include "rotation_blocks.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
typedef double Four __attribute__((vector_size(32)));

inline Four loadFour(const double* p)
{
  Four v;
  std::memcpy(&v, p, sizeof(Four));
  return v;
}

inline void addFour(double* p, Four v)
{
  v += loadFour(p);
  std::memcpy(p, &v, sizeof(Four));
}

/** Adds a block of nine doubles to one of the matrix. */
inline void addBlock(const double* block, double* to)
{
  addFour(to, loadFour(block));
  addFour(to + 4, loadFour(block + 4));
  to[8] += block[8];
}

inline void storeBlock(const PackMat& block, Pack* out)
{
  for (int k = 0; k < 9; ++k)
  {
    out[k] = block.m[k % 3][k / 3];
  }
}

/** Nodes of the blocks of a linear tet. */
constexpr BlockNodes kBlocks[kTetBlocks] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {0, 1},
                                            {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/**
 * The blocks of a linear tet, kBlocks, nine packs each by columns, given those of nodes 1, 2, 3:
 * blockOf(a, b) for 0 <= a <= b < 3 couples nodes a + 1 and b + 1. Those of node 0 follow, as a
 * common translation meets no resistance.
 */
template <typename Block>
inline void linearBlocks(const Block& blockOf, Pack* out)
{
  constexpr int kUpper[3][3] = {{0, 7, 8}, {7, 0, 9}, {8, 9, 0}};  // blocks (1, 2), (1, 3), (2, 3)
  PackMat blocks[3][3];
  for (int a = 0; a < 3; ++a)
  {
    for (int b = a; b < 3; ++b)
    {
      blocks[a][b] = blockOf(a, b);
      storeBlock(blocks[a][b], out + 9 * (a == b ? a + 1 : kUpper[a][b]));
    }
  }
  PackMat corner;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      const Pack row[3] = {blocks[0][0].m[i][j] + blocks[0][1].m[i][j] + blocks[0][2].m[i][j],
                           blocks[0][1].m[j][i] + blocks[1][1].m[i][j] + blocks[1][2].m[i][j],
                           blocks[0][2].m[j][i] + blocks[1][2].m[j][i] + blocks[2][2].m[i][j]};
      for (int a = 0; a < 3; ++a)
      {
        out[9 * (4 + a) + 3 * i + j] = -row[a];
      }
      corner.m[i][j] = row[0] + row[1] + row[2];
    }
  }
  storeBlock(corner, out);
}

/** Adds blocks of a few tets, nine values each in rows[lane], to those of the matrix: a tet after
 * the other, so that the order does not depend on the number of lanes. */
template <int kBlockCount, std::size_t kRow>
SOFT_TISSUE_INLINE void addBlocks(const double (*rows)[kRow], const Index* positions,
                                  double* values)
{
  for (int lane = 0; lane < kLanes; ++lane)
  {
    const Index* position = positions + lane;
    for (int block = 0; block < kBlockCount; ++block, position += kTetLanes)
    {
      addBlock(rows[lane] + 9 * block, values + 9 * static_cast<long>(*position));
    }
  }
}

/**
 * Blocks of a law of the invariants I_C and J, without singular values: with q_a = F b_a and
 * r_a = cof(F) b_a for the shape gradient b_a,
 * K_ab / V = m (b_a . b_b) I + curvature (q_a + tilt r_a) (q_b + tilt r_b)^T + volumetric r_a r_b^T
 * + pressure [F (b_a x b_b)] where [w]_ij = e_ijk w_k.
 */
template <typename Material>
class InvariantBlocks
{
 public:
  InvariantBlocks(const DeformedLanes& t, const InvariantStiffness& k)
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
    for (int n = 0; n < 9 && Material::kTilt != 0.0; ++n)
    {
      q_.m[n / 3][n % 3] += Material::kTilt * r_.m[n / 3][n % 3];
    }
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
  explicit PrincipalBlocks(const Lanes<Material>& t) : svd_(signedSvd(t.f))
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

/** Blocks of the linear law, constants mu and lambda:
 * K_ab / V = mu (b_a . b_b) I + mu b_b b_a^T + lambda b_a b_b^T. */
class HookeBlocks
{
 public:
  template <typename Material>
  explicit HookeBlocks(const Lanes<Material>& t)
      : gradients_(t.gradients), mu_(t.volume * t.constants[0]), lambda_(t.volume * t.constants[1])
  {}

  PackMat operator()(int a, int b) const
  {
    const Pack* ba = gradients_.m[a];
    const Pack* bb = gradients_.m[b];
    const Pack shear = mu_ * (ba[0] * bb[0] + ba[1] * bb[1] + ba[2] * bb[2]);
    PackMat block;
    for (int i = 0; i < 3; ++i)
    {
      for (int j = 0; j < 3; ++j)
      {
        const Pack both = mu_ * bb[i] * ba[j] + lambda_ * ba[i] * bb[j];
        block.m[i][j] = i == j ? both + shear : both;
      }
    }
    return block;
  }

 private:
  const PackMat& gradients_;
  Pack mu_, lambda_;
};

/**
 * Blocks of what tets remember: with S the second Piola-Kirchhoff stress and q_a = F b_a,
 * K_ab / V = (b_a . S b_b) I + mu (b_a . b_b) F F^T + mu q_b q_a^T + lambda q_a q_b^T.
 * All but the first is positive; the projected one has the positive part of S in it.
 */
template <bool kProjected>
class MemoryBlocks
{
 public:
  explicit MemoryBlocks(const Lanes<StrainMemory>& t)
      : q_(timesTransposed(t.gradients, t.f)),
        metric_(timesTransposed(t.gradients, t.gradients)),
        left_(timesTransposed(t.f, t.f)),
        mu_(t.volume * t.constants[0]),
        lambda_(t.volume * t.constants[1])
  {
    PackMat s = StrainMemory::secondStress(t.f, t.constants);
    if (kProjected)
    {
      projectSymmetric(s);
    }
    stressed_ = timesTransposed(timesTransposed(t.gradients, s), t.gradients);
    for (int n = 0; n < 9; ++n)
    {
      stressed_.m[n / 3][n % 3] *= t.volume;
    }
  }

  PackMat operator()(int a, int b) const
  {
    PackMat block;
    const Pack shear = mu_ * metric_.m[a][b];
    for (int i = 0; i < 3; ++i)
    {
      const Pack mixed = mu_ * q_.m[b][i], own = lambda_ * q_.m[a][i];
      for (int j = 0; j < 3; ++j)
      {
        const Pack both = shear * left_.m[i][j] + mixed * q_.m[a][j] + own * q_.m[b][j];
        block.m[i][j] = i == j ? both + stressed_.m[a][b] : both;
      }
    }
    return block;
  }

 private:
  PackMat q_, metric_, left_, stressed_;
  Pack mu_, lambda_;
};

/** Those of a law by the way that is the shortest; a law that is positive needs no projection. */
template <typename Material, bool kProjected>
inline void materialBlocks(const Lanes<Material>& t, Pack* out)
{
  if constexpr (Material::kForm == Form::linear)
  {
    linearBlocks(HookeBlocks(t), out);
  }
  else if constexpr (Material::kForm == Form::strain)
  {
    linearBlocks(MemoryBlocks<kProjected>(t), out);
  }
  else if constexpr (Material::kForm == Form::invariants && !kProjected)
  {
    linearBlocks(InvariantBlocks<Material>(t, Material::stiffness(t.f, t.constants)), out);
  }
  else if constexpr (Material::kForm == Form::rotation && !kProjected)
  {
    const RotationBlocks<Material> blocks(t);
    linearBlocks(blocks, out);
    if (any(blocks.clear() == 0))
    {
      Pack others[9 * kTetBlocks];
      linearBlocks(PrincipalBlocks<Material, kProjected>(t), others);
      for (int k = 0; k < 9 * kTetBlocks; ++k)
      {
        out[k] = blocks.clear() ? out[k] : others[k];
      }
    }
  }
  else
  {
    linearBlocks(PrincipalBlocks<Material, kProjected>(t), out);
  }
}

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
