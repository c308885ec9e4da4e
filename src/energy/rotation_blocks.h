/**
 * The second derivative of the corotated law. Included by kernel files only (see pack.h).
 */
#pragma once

#include "tet_lanes.h"

namespace soft_tissue
{
namespace SOFT_TISSUE_KERNELS
{
/**
 * Blocks of the corotated law by its rotation R, stress 2 mu F + tension R: with B_a = R b_a and
 * H = (tr S I - F R^T)^-1, which turns moments into spins,
 * K_ab / V = 2 mu (b_a . b_b) I + lambda B_a B_b^T - tension [B_a x] H [B_b x].
 */
template <typename Material>
class RotationBlocks
{
 public:
  explicit RotationBlocks(const Lanes<Material>& t)
      : metric_(timesTransposed(t.gradients, t.gradients))
  {
    const Polar polar_f = polar(t.f);
    // H has no eigenvalue beyond 1 / kLeastPair there.
    clear_ = polar_f.clear && polar_f.trace > 1e3 * Material::kLeastPair;
    shear_ = 2.0 * t.volume * t.constants[0];
    lambda_ = t.volume * t.constants[1];
    q_ = timesTransposed(t.gradients, polar_f.rotation);
    PackMat g = timesTransposed(t.f, polar_f.rotation);
    for (int k = 0; k < 9; ++k)
    {
      g.m[k / 3][k % 3] = k % 4 == 0 ? polar_f.trace - g.m[k / 3][k % 3] : -g.m[k / 3][k % 3];
    }
    const PackMat adjoint = cofactor(g);
    const Pack factor =
        -t.volume * Material::tension(polar_f.trace, t.constants) /
        (g.m[0][0] * adjoint.m[0][0] + g.m[0][1] * adjoint.m[0][1] + g.m[0][2] * adjoint.m[0][2]);
    for (int b = 0; b < 3; ++b)
    {
      for (int i = 0; i < 3; ++i)
      {
        for (int j = 0; j < 3; ++j)
        {
          const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
          // Column j of [B_b x] has B_b[j2] in row j1 and -B_b[j1] in row j2.
          spins_[b].m[i][j] =
              factor * (adjoint.m[i][j1] * q_.m[b][j2] - adjoint.m[i][j2] * q_.m[b][j1]);
        }
      }
    }
  }

  PackMat operator()(int a, int b) const
  {
    PackMat block;
    const Pack* qa = q_.m[a];
    for (int i = 0; i < 3; ++i)
    {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      const Pack own = lambda_ * qa[i];
      for (int j = 0; j < 3; ++j)
      {
        const Pack both =
            own * q_.m[b][j] + (qa[i1] * spins_[b].m[i2][j] - qa[i2] * spins_[b].m[i1][j]);
        block.m[i][j] = i == j ? both + shear_ * metric_.m[a][b] : both;
      }
    }
    return block;
  }

  /** Where they are what the law says. */
  Mask clear() const { return clear_; }

 private:
  PackMat q_, metric_, spins_[3];
  Pack shear_, lambda_;
  Mask clear_;
};

}  // namespace SOFT_TISSUE_KERNELS
}  // namespace soft_tissue
