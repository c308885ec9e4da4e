#pragma once

#include <cmath>

#include "support/finite_difference.h"
#include "support/geometry_oracle.h"

namespace soft_tissue::test
{
/** Largest error of directional derivatives, over the gradient's norm. */
inline double gradientError(EnergyTerm& contact, const Points& x, RandomGeometry& random)
{
  const Eigen::VectorXd gradient = gradientOf(contact, x);
  double worst = 0.0;
  for (int direction = 0; direction < 4; ++direction)
  {
    Eigen::VectorXd way(3 * x.size());
    for (Eigen::Index k = 0; k < way.size(); ++k)
    {
      way[k] = random.uniform(-1.0, 1.0);
    }
    const double difference = derivative(
        [&](double s) {
          Points moved = x;
          for (Eigen::Index k = 0; k < way.size(); ++k)
          {
            moved[k / 3][k % 3] += s * way[k];
          }
          return contact.value(moved);
        },
        1e-8);
    worst = std::max(worst, std::abs(difference - gradient.dot(way)) / gradient.norm());
  }
  return worst;
}

/** The second derivative where it exists: differences of the exact gradient that agree on both
 * sides. */
inline Eigen::MatrixXd centralDifference(EnergyTerm& contact, const Points& x)
{
  constexpr double kStep = 1e-9;
  Eigen::MatrixXd hessian(3 * x.size(), 3 * x.size());
  for (Eigen::Index k = 0; k < hessian.cols(); ++k)
  {
    Points moved = x;
    moved[k / 3][k % 3] += kStep;
    hessian.col(k) = gradientOf(contact, moved);
    moved[k / 3][k % 3] -= 2.0 * kStep;
    hessian.col(k) -= gradientOf(contact, moved);
  }
  return hessian / (2.0 * kStep);
}

}  // namespace soft_tissue::test
