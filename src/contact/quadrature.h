#pragma once

#include <array>

#include "soft_tissue_sim/collision/interval.h"

namespace soft_tissue
{
/** Point of a quadrature rule on [0, 1] and its weight; weights sum to 1. */
struct QuadraturePoint
{
  double parameter;
  double weight;
};

/** Gauss rule exact to degree 3. */
constexpr std::array<QuadraturePoint, 2> kGauss2 = {
    {{0.21132486540518711775, 0.5}, {0.78867513459481288225, 0.5}}};

/** Gauss rule exact to degree 5. */
constexpr std::array<QuadraturePoint, 3> kGauss3 = {
    {{0.11270166537925831148, 5.0 / 18.0}, {0.5, 4.0 / 9.0}, {0.88729833462074168852, 5.0 / 18.0}}};

/** Calls visit(parameter, weight) for a rule's points carried to an interval. */
template <std::size_t N, typename Visit>
void forEachPoint(const std::array<QuadraturePoint, N>& rule, const Interval& on,
                  const Visit& visit)
{
  const double length = on.end - on.begin;
  for (const QuadraturePoint& point : rule)
  {
    visit(on.begin + point.parameter * length, point.weight * length);
  }
}

}  // namespace soft_tissue
