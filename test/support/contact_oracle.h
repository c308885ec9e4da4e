#pragma once

#include <Eigen/Dense>
#include <Eigen/LU>

#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::test
{
/** Gradients of a tet's barycentric weights, columns, from the inverse of its edge matrix. */
inline Eigen::Matrix<double, 3, 4> weightGradients(const std::array<Vec3, 4>& x)
{
  Mat3 edges;
  edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
  Eigen::Matrix<double, 3, 4> gradients;
  gradients.rightCols<3>() = edges.inverse().transpose();
  gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
  return gradients;
}

/**
 * d2 d / dx_i dx_j of the interpolated depth d = sum beta_k d_k at a fixed point, 12 x 12.
 *
 * From dbeta_k/dx_j = -beta_j grad(beta_k) and d grad(beta_k)/dx_j = -grad(beta_j) grad(beta_k)^T:
 * the block is beta_j g grad(beta_i)^T + beta_i grad(beta_j) g^T, with g = grad d.
 */
inline Eigen::MatrixXd interpolatedCurvature(const std::array<Vec3, 4>& x, const Vec3& p,
                                             const Eigen::Vector4d& depth)
{
  const Eigen::Matrix<double, 3, 4> b = weightGradients(x);
  const Vec3 g = b * depth;
  Eigen::Vector4d beta = b.transpose() * (p - x[0]);
  beta[0] += 1.0;
  Eigen::MatrixXd curvature(12, 12);
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      curvature.block<3, 3>(3 * i, 3 * j) =
          beta[j] * g * b.col(i).transpose() + beta[i] * b.col(j) * g.transpose();
    }
  }
  return curvature;
}

/** d2 d / dx2 of the depth d = R - |x - centre| in a ball, 3 x 3. */
inline Mat3 ballCurvature(const Vec3& x, const Vec3& centre)
{
  const Vec3 out = (x - centre).normalized();
  return -(Mat3::Identity() - out * out.transpose()) / (x - centre).norm();
}

}  // namespace soft_tissue::test
