#pragma once

#include <cmath>

namespace soft_tissue
{
/** A function of w and its two derivatives. */
struct SoftRoot
{
  double value, slope, curvature;
};

/** Below this the root is replaced by a polynomial in w with the same value and two derivatives: a
 * length or area as a function of positions has a tip where it vanishes, and what is pulled through
 * itself there would meet infinite stiffness. */
constexpr double kSmallRoot = 0.1;

/** The square root of w >= 0 as laws of lengths and areas see it. */
inline SoftRoot softRoot(double w)
{
  constexpr double kSmall = kSmallRoot;
  if (w >= kSmall * kSmall)
  {
    const double root = std::sqrt(w);
    return {root, 0.5 / root, -0.25 / (w * root)};
  }
  const double u = w / (kSmall * kSmall);
  return {kSmall * (0.375 + u * (0.75 - 0.125 * u)), (0.75 - 0.25 * u) / kSmall,
          -0.25 / (kSmall * kSmall * kSmall)};
}

}  // namespace soft_tissue
