#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace soft_tissue::test
{
/** A place by its barycentric coordinates, and its share of the volume or area. */
template <int kCorners>
struct Quadrature
{
  Eigen::Matrix<double, kCorners, 1> l;
  double weight;
};

/** Gauss points on [0, 1], exact to degree 5. */
inline const double (&gaussLine())[3][2]
{
  static const double points[3][2] = {
      {0.5 - std::sqrt(0.15), 5.0 / 18.0}, {0.5, 8.0 / 18.0}, {0.5 + std::sqrt(0.15), 5.0 / 18.0}};
  return points;
}

/** Points of a triangle, exact to degree 4: those of a square, one side of it drawn together. */
inline std::vector<Quadrature<3>> triangleQuadrature()
{
  std::vector<Quadrature<3>> all;
  for (const auto& a : gaussLine())
  {
    for (const auto& b : gaussLine())
    {
      const double rest = 1.0 - a[0];
      all.push_back({{a[0], rest * b[0], rest * (1.0 - b[0])}, 2.0 * rest * a[1] * b[1]});
    }
  }
  return all;
}

/** Points of a tet, exact to degree 3: those of a cube, drawn together. */
inline std::vector<Quadrature<4>> tetQuadrature()
{
  std::vector<Quadrature<4>> all;
  for (const auto& a : gaussLine())
  {
    for (const Quadrature<3>& b : triangleQuadrature())
    {
      const double rest = 1.0 - a[0];
      all.push_back({{a[0], rest * b.l[0], rest * b.l[1], rest * b.l[2]},
                     3.0 * rest * rest * a[1] * b.weight});
    }
  }
  return all;
}

}  // namespace soft_tissue::test
