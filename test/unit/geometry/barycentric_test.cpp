#include "soft_tissue_sim/geometry/barycentric.h"

#include <gtest/gtest.h>

#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

TEST(TetCoordinates, GivesBackTheWeightsOfAnyPoint)
{
  RandomGeometry random(1);
  for (int trial = 0; trial < 500; ++trial)
  {
    const double unit = trial % 2 == 0 ? 1.0 : 1e-4;
    const Vec3 x[4] = {unit * random.point(1), unit * random.point(1), unit * random.point(1),
                       unit * random.point(1)};
    const auto tet = tetCoordinates(x[0], x[1], x[2], x[3]);
    const double volume6 = (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]);
    ASSERT_TRUE(tet.has_value());
    const double conditioning = unit * unit * unit / std::abs(volume6);
    Eigen::Vector4d weights;
    weights << random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), 0;
    weights[3] = 1.0 - weights.head<3>().sum();
    const Vec3 p = weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2] + weights[3] * x[3];
    EXPECT_LE((tet->weights(p) - weights).norm(), 1e-13 * (1 + conditioning));
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < 4; ++j)
      {
        const double difference = tet->gradients.col(i).dot(x[j] - x[(j + 1) % 4]);
        const double expected = (i == j ? 1.0 : 0.0) - (i == (j + 1) % 4 ? 1.0 : 0.0);
        EXPECT_NEAR(difference, expected, 1e-13 * (1 + conditioning));
      }
    }
  }
}

TEST(TetCoordinates, AcceptsBothHandednesses)
{
  const Vec3 p(0.1, 0.2, 0.3);
  const auto right = tetCoordinates({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const auto left = tetCoordinates({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  ASSERT_TRUE(right && left);
  EXPECT_TRUE(right->weights(p).isApprox(Eigen::Vector4d(0.4, 0.1, 0.2, 0.3)));
  EXPECT_TRUE(left->weights(p).isApprox(Eigen::Vector4d(0.4, 0.2, 0.1, 0.3)));
}

TEST(TetCoordinates, AcceptsSliversAndRefusesFlatTetsInAnyUnitAndPose)
{
  RandomGeometry random(2);
  for (const double unit : {1e-6, 1e-3, 1.0, 1e3})
  {
    const Pose X = random.pose(0.0);
    const auto flattened = [&](double height) {
      const auto at = [&](double x, double y, double z) {
        return Vec3(X * (unit * Vec3(x, y, z)));
      };
      return tetCoordinates(at(0, 0, 0), at(1, 0, 0), at(0, 1, 0), at(0.3, 0.3, height));
    };
    EXPECT_TRUE(flattened(1e-3).has_value());
    EXPECT_TRUE(flattened(1e-8).has_value());
    EXPECT_FALSE(flattened(1e-13).has_value());
    EXPECT_FALSE(flattened(0.0).has_value());
  }
  const Vec3 p(1, 2, 3);
  EXPECT_FALSE(tetCoordinates(p, p, p, p).has_value());
  EXPECT_FALSE(tetCoordinates(p, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3::Constant(NAN)).has_value());
  EXPECT_FALSE(
      tetCoordinates(p, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3::Constant(INFINITY)).has_value());
}

}  // namespace
}  // namespace soft_tissue
