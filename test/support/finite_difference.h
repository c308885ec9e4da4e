#pragma once

#include <Eigen/Dense>
#include <algorithm>

#include "soft_tissue_sim/energy/term.h"

namespace soft_tissue
{
namespace test
{
/** Sixth-order central difference of f at 0: slow, obvious, exact to about 1e-11 of smooth
 * functions. */
template <typename Function>
auto derivative(const Function& f, double h) -> decltype(f(h))
{
  return ((f(3 * h) - f(-3 * h)) - 9.0 * (f(2 * h) - f(-2 * h)) + 45.0 * (f(h) - f(-h))) /
         (60.0 * h);
}

/** Gradient of a term by differences of its value, 3N. */
inline Eigen::VectorXd differenceGradient(EnergyTerm& term, const Points& x, double h)
{
  Eigen::VectorXd g(3 * x.size());
  for (Eigen::Index k = 0; k < g.size(); ++k)
  {
    g[k] = derivative(
        [&](double s) {
          Points moved = x;
          moved[k / 3][k % 3] += s;
          return term.value(moved);
        },
        h);
  }
  return g;
}

/** Gradient of a term as it says, 3N. */
inline Eigen::VectorXd gradientOf(EnergyTerm& term, const Points& x)
{
  Points g(x.size(), Vec3::Zero());
  term.addGradient(x, g);
  return Eigen::Map<Eigen::VectorXd>(g.data()->data(), 3 * x.size());
}

/** Second derivative of a term by differences of its gradient, 3N x 3N. */
inline Eigen::MatrixXd differenceHessian(EnergyTerm& term, const Points& x, double h)
{
  Eigen::MatrixXd hessian(3 * x.size(), 3 * x.size());
  for (Eigen::Index k = 0; k < hessian.cols(); ++k)
  {
    hessian.col(k) = derivative(
        [&](double s) -> Eigen::VectorXd {
          Points moved = x;
          moved[k / 3][k % 3] += s;
          return gradientOf(term, moved);
        },
        h);
  }
  return hessian;
}

/** A block matrix as a dense one: its upper blocks and their transposes. */
inline Eigen::MatrixXd dense(const BlockMatrix& a)
{
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(3 * a.rows(), 3 * a.rows());
  for (Index row = 0; row < a.rows(); ++row)
  {
    for (Index k = a.diagonal(row); k < a.offsets()[row + 1]; ++k)
    {
      const Index column = a.columns()[k];
      const Mat3 block = Eigen::Map<const Mat3>(a.block(k));
      m.block<3, 3>(3 * column, 3 * row) = block.transpose();
      m.block<3, 3>(3 * row, 3 * column) = block;
    }
  }
  for (const Coupling& c : a.couplings())
  {
    m.block<3, 3>(3 * c.row, 3 * c.column) += c.block;
    m.block<3, 3>(3 * c.column, 3 * c.row) += c.block.transpose();
  }
  const OuterProducts& outer = a.outer();
  for (Index k = 0; k < outer.size(); ++k)
  {
    Eigen::VectorXd g = Eigen::VectorXd::Zero(m.rows());
    for (Index place = outer.offsets()[k]; place < outer.offsets()[k + 1]; ++place)
    {
      g.segment<3>(3 * outer.nodes()[place]) += Eigen::Map<const Vec3>(outer.vector(place));
    }
    m += outer.weights()[k] * g * g.transpose();
  }
  return m;
}

/** Second derivative of a term as it says, 3N x 3N. */
inline Eigen::MatrixXd hessianOf(EnergyTerm& term, const Points& x, const Adjacency& neighbours,
                                 Curvature curvature = Curvature::positive)
{
  BlockMatrix hessian(neighbours);
  term.addHessian(x, curvature, hessian);
  return dense(hessian);
}

/** The nearest positive semi-definite matrix: negative eigenvalues set to zero. */
inline Eigen::MatrixXd projected(const Eigen::MatrixXd& m)
{
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (m + m.transpose()));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

inline double smallestEigenvalue(const Eigen::MatrixXd& m)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

}  // namespace test
}  // namespace soft_tissue
