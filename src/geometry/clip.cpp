#include "soft_tissue_sim/geometry/clip.h"

#include <algorithm>
#include <cmath>

namespace soft_tissue
{
namespace
{
constexpr double kTouching = 1e-12;

Eigen::Vector4d snapped(Eigen::Vector4d weights)
{
  return (weights.array().abs() <= kTouching).select(0.0, weights);
}
}  // namespace

std::optional<ClippedSegment> clipSegment(const Vec3& a, const Vec3& b, const TetCoordinates& tet)
{
  const Eigen::Vector4d at_a = snapped(tet.weights(a));
  const Eigen::Vector4d at_b = snapped(tet.weights(b));
  ClippedSegment piece;
  for (int i = 0; i < 4; ++i)
  {
    if (at_a[i] < 0.0 && at_b[i] < 0.0)
    {
      return std::nullopt;
    }
    if (at_a[i] < 0.0)
    {
      piece.lambda1 = std::max(piece.lambda1, at_a[i] / (at_a[i] - at_b[i]));
    }
    else if (at_b[i] < 0.0)
    {
      piece.lambda2 = std::min(piece.lambda2, at_a[i] / (at_a[i] - at_b[i]));
    }
  }
  if (!(piece.lambda1 <= piece.lambda2 + kTouching))
  {
    return std::nullopt;
  }
  if (piece.lambda1 > piece.lambda2)
  {
    piece.lambda1 = piece.lambda2 = 0.5 * (piece.lambda1 + piece.lambda2);
  }
  piece.weights1 = at_a + piece.lambda1 * (at_b - at_a);
  piece.weights2 = at_a + piece.lambda2 * (at_b - at_a);
  return piece;
}

}  // namespace soft_tissue
