#include "soft_tissue_sim/energy/anchor_springs.h"

#include <gtest/gtest.h>

#include "support/finite_difference.h"
#include "support/simple_terms.h"

namespace soft_tissue::test
{
namespace
{
const Points kPlaces = {{0.1, -0.2, 0.3}, {0.0, 0.5, -0.1}, {-0.4, 0.2, 0.2}};

/** The second node is tied twice, the last not at all. */
AnchorSprings someSprings()
{
  AnchorSprings term;
  term.springs() = {{0, 3.0, Vec3(0.2, 0, 0)}, {1, 5.0, Vec3(0, 0, 1)}, {1, 7.0, Vec3(1, 0, 0)}};
  return term;
}

TEST(AnchorSprings, EnergyIsHalfTheStiffnessTimesTheSquareOfTheDistance)
{
  AnchorSprings term = someSprings();
  const double expected = 0.5 * 3.0 * (0.01 + 0.04 + 0.09) + 0.5 * 5.0 * (0.25 + 1.21) +
                          0.5 * 7.0 * (1.0 + 0.25 + 0.01);
  EXPECT_NEAR(term.value(kPlaces), expected, 1e-14);
}

TEST(AnchorSprings, GradientAndHessianAreDerivatives)
{
  AnchorSprings term = someSprings();
  EXPECT_LT((gradientOf(term, kPlaces) - differenceGradient(term, kPlaces, 1e-3)).norm(), 1e-10);
  const Adjacency none = noNeighbours(3);
  const Eigen::MatrixXd expected = differenceHessian(term, kPlaces, 1e-3);
  for (const Curvature curvature : {Curvature::exact, Curvature::positive})
  {
    EXPECT_LT((hessianOf(term, kPlaces, none, curvature) - expected).norm(), 1e-10);
  }
}

TEST(AnchorSprings, ForcesOnNodeAndPlaceAreOpposite)
{
  AnchorSprings term = someSprings();
  term.springs().resize(1);
  const Eigen::VectorXd gradient = gradientOf(term, kPlaces);
  EXPECT_LT((Vec3(gradient.head<3>()) - term.springs()[0].force(kPlaces)).norm(), 1e-15);
}

}  // namespace
}  // namespace soft_tissue::test
