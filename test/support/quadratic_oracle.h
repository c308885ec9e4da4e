#pragma once

#include <Eigen/LU>
#include <cmath>

#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/quadratic_tets.h"
#include "support/deformed_tets.h"

namespace soft_tissue::test
{
using Barycentric = Eigen::Vector4d;

/** Gradients of the ten shape functions L (2 L - 1) and 4 L L of a straight quadratic tet, 1/m. */
inline Eigen::Matrix<double, 3, 10> shapeGradients(const QuadraticTet& n, const Points& rest,
                                                   const Barycentric& l)
{
  Mat3 edges;
  edges << rest[n[1]] - rest[n[0]], rest[n[2]] - rest[n[0]], rest[n[3]] - rest[n[0]];
  Eigen::Matrix<double, 3, 4> linear;
  linear.rightCols<3>() = edges.inverse().transpose();
  linear.col(0) = -linear.rightCols<3>().rowwise().sum();
  Eigen::Matrix<double, 3, 10> gradients;
  for (int k = 0; k < 4; ++k)
  {
    gradients.col(k) = (4.0 * l[k] - 1.0) * linear.col(k);
  }
  for (int e = 0; e < 6; ++e)
  {
    const int a = kTetEdges[e][0], b = kTetEdges[e][1];
    gradients.col(4 + e) = 4.0 * (l[a] * linear.col(b) + l[b] * linear.col(a));
  }
  return gradients;
}

inline Mat3 quadraticF(const QuadraticTet& n, const Points& rest, const Points& x,
                       const Barycentric& l)
{
  const auto gradients = shapeGradients(n, rest, l);
  Mat3 f = Mat3::Zero();
  for (int a = 0; a < 10; ++a)
  {
    f += x[n[a]] * gradients.col(a).transpose();
  }
  return f;
}

/** Points of the rule that is exact for quadratic functions, a quarter of the volume each. */
inline std::vector<Barycentric> gaussPoints()
{
  const double far = (5.0 - std::sqrt(5.0)) / 20.0;
  std::vector<Barycentric> points(4, Barycentric::Constant(far));
  for (int k = 0; k < 4; ++k)
  {
    points[k][k] = 1.0 - 3.0 * far;
  }
  return points;
}

/** Energy density and von Mises stress of a law: those of a linear tet with this F. */
struct LawAt
{
  double energy;  // J/m^3
  double von_mises;

  LawAt(MaterialModel model, const TetStiffnessParameters& parameters, const Mat3& f)
  {
    TetElasticity unit(unitTet(), model, {parameters}, 0);
    const Points x = deformedUnitTet(f);
    energy = 6.0 * unit.value(x);
    std::vector<float> stress;
    unit.vonMises(x, stress);
    von_mises = stress[0];
  }
};

inline double volumeOf(const QuadraticTet& n, const Points& rest)
{
  return signedVolume6(rest[n[0]], rest[n[1]], rest[n[2]], rest[n[3]]) / 6.0;
}

/** Positions under F, with all nodes shaken by up to `size` so that F differs within elements. */
inline Points shaken(const Points& rest, const Mat3& f, double size, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  Points x;
  for (const Vec3& p : rest)
  {
    x.push_back(Vec3(0.3, -0.2, 0.5) + f * p +
                Vec3(uniform(random), uniform(random), uniform(random)));
  }
  return x;
}

}  // namespace soft_tissue::test
