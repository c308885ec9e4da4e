#pragma once

#include <array>

#include "soft_tissue_sim/base/types.h"

namespace soft_tissue
{
/**
 * One quadrature point of the contact energy E = integral of 1/2 kappa d^2 dA.
 *
 * Both responses, point- and segment-in-object, both directions of a pair, and every kind of depth end as
 * samples: energy 1/2 kappa area d^2, and d's derivative by node j is coefficient[j] * gradient.
 */
struct ContactSample
{
  static constexpr int kMaxNodes = 6;  ///< an edge's two nodes and a tet's four

  Vec3 position;                              ///< m, world
  Vec3 gradient;                              ///< unit where d is a true distance: derivative of d by the intruding point
  double depth = 0.0;                         ///< m, > 0
  double stiffness_area = 0.0;                ///< kappa times area, N/m
  double area = 0.0;                          ///< m^2
  int count = 0;                              ///< nodes that d depends on
  std::array<Index, kMaxNodes> node;          ///< rows of x
  std::array<double, kMaxNodes> coefficient;  ///< intruder weights, minus host weights
  int tool_sign = 0;                          ///< +1: the tool intrudes, force on it is -kappa area d gradient; -1: the tissue intrudes
};

}  // namespace soft_tissue
