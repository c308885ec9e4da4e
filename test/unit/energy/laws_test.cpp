#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "support/deformed_tets.h"
#include "support/finite_difference.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 5000.0;
constexpr double kPoisson = 0.4;

/** A law, as one tet of a sixth of a cubic metre says it is. */
class Law
{
 public:
  Law(MaterialModel model, const TetStiffnessParameters& parameters)
      : term_(unitTet(), model, {parameters}, 0)
  {}

  double energy(const Mat3& f) { return 6.0 * term_.value(deformedUnitTet(f)); }

  /** First Piola-Kirchhoff stress: nodes 1, 2, 3 of the unit tet are the columns of F. */
  Mat3 stress(const Mat3& f)
  {
    const Eigen::VectorXd gradient = gradientOf(term_, deformedUnitTet(f));
    return 6.0 * Eigen::Map<const Mat3>(gradient.data() + 3);
  }

  /** dP/dF, 9 x 9 by columns. */
  Eigen::MatrixXd stiffness(const Mat3& f)
  {
    const Adjacency neighbours = nodeNeighbours(4, unitTet().tets);
    return 6.0 * hessianOf(term_, deformedUnitTet(f), neighbours, Curvature::exact)
                     .bottomRightCorner(9, 9);
  }

 private:
  TetElasticity term_;
};

/** Energy densities as the books write them, in the long numbers of the machine. */
long double exponentialEnergy(const Mat3& f, const Lame& lame, double b)
{
  const long double j = f.determinant();
  const long double q = f.cast<long double>().squaredNorm() - 2.0L * j - 1.0L;
  return 0.5L * lame.mu / b * std::expm1(b * q) +
         0.5L * (lame.lambda + lame.mu) * (j - 1.0L) * (j - 1.0L);
}

long double logEnergy(const Mat3& f, const Lame& lame)
{
  const long double log_j = std::log(static_cast<long double>(f.determinant()));
  return 0.5L * lame.mu * (f.cast<long double>().squaredNorm() - 3.0L) - lame.mu * log_j +
         0.5L * lame.lambda * log_j * log_j;
}

long double stVenantKirchhoffEnergy(const Mat3& f, const Lame& lame)
{
  const Mat3 e = 0.5 * (f.transpose() * f - Mat3::Identity());
  return lame.mu * e.squaredNorm() + 0.5 * lame.lambda * e.trace() * e.trace();
}

long double linearEnergy(const Mat3& f, const Lame& lame)
{
  const Mat3 e = 0.5 * (f + f.transpose()) - Mat3::Identity();
  return lame.mu * e.squaredNorm() + 0.5 * lame.lambda * e.trace() * e.trace();
}

TEST(Laws, HaveTheEnergiesOfTheirFormulas)
{
  const Lame lame = lameFrom(kYoung, kPoisson);
  Law log(MaterialModel::neo_hookean_log, {kYoung, kPoisson});
  Law green(MaterialModel::st_venant_kirchhoff, {kYoung, kPoisson});
  Law linear(MaterialModel::linear, {kYoung, kPoisson});
  for (const NamedF& f : deformationGradients())
  {
    const auto check = [&](Law& law, long double expected) {
      const auto energy = static_cast<double>(expected);
      EXPECT_NEAR(law.energy(f.f), energy, 1e-12 * (kYoung + std::abs(energy))) << f.name;
    };
    check(green, stVenantKirchhoffEnergy(f.f, lame));
    check(linear, linearEnergy(f.f, lame));
    if (f.f.determinant() > kLeastLogVolume)
    {
      check(log, logEnergy(f.f, lame));
    }
    for (const double b : {1e-3, 0.5, 3.0, 20.0})
    {
      Law exponential(MaterialModel::exponential, {kYoung, kPoisson, b});
      if (b * (f.f.squaredNorm() - 2.0 * f.f.determinant() - 1.0) < kSteepestExponent)
      {
        check(exponential, exponentialEnergy(f.f, lame, b));
      }
    }
  }
}

/** Where volume is kept, pulling takes exp(b (I_C - 3)) times the force of a neo-Hookean solid. */
TEST(Laws, ExponentialIsDemiraysWhereVolumeIsKept)
{
  const double mu = lameFrom(kYoung, kPoisson).mu;
  for (const double b : {0.1, 2.0, 8.0})
  {
    Law law(MaterialModel::exponential, {kYoung, kPoisson, b});
    for (const double s : {0.6, 0.9, 1.0, 1.2, 1.5})
    {
      const double side = 1.0 / std::sqrt(s);
      const Mat3 p = law.stress(Vec3(s, side, side).asDiagonal());
      // The pressure that keeps the volume is what the sides need to be free.
      const double axial = p(0, 0) - p(1, 1) * side / s;
      const double expected = mu * std::exp(b * (s * s + 2.0 / s - 3.0)) * (s - 1.0 / (s * s));
      EXPECT_NEAR(axial, expected, 1e-12 * (kYoung + std::abs(expected))) << b << " " << s;
    }
  }
}

/** Value, slope and curvature along a way through F that crosses the place where a law's formula
 * ends, from both sides. */
void expectSmoothAcross(Law& law, const std::function<double(const Mat3&)>& side)
{
  std::mt19937 random(4);
  const Mat3 inner = stretched(random, 1.3, 0.9, 0.8);
  const Mat3 outer = stretched(random, 3.0, 0.7, -0.6);
  double low = 0.0, high = 1.0;
  ASSERT_LT(side(inner) * side(outer), 0.0);
  for (int k = 0; k < 60; ++k)
  {
    const double middle = 0.5 * (low + high);
    const Mat3 f = inner + middle * (outer - inner);
    (side(f) * side(inner) > 0.0 ? low : high) = middle;
  }
  const double step = 1e-9;
  const auto at = [&](double t) -> Mat3 { return inner + t * (outer - inner); };
  const Mat3 before = at(low - step), after = at(low + step);
  ASSERT_LT(side(before) * side(after), 0.0);
  const Mat3 p = law.stress(before), q = law.stress(after);
  const Eigen::MatrixXd k = law.stiffness(before), l = law.stiffness(after);
  const double move = (after - before).norm();
  EXPECT_NEAR(law.energy(before), law.energy(after), 2.0 * p.norm() * move);
  EXPECT_LT((p - q).norm(), 2.0 * k.norm() * move);
  EXPECT_LT((k - l).norm(), 1e-5 * k.norm());
}

TEST(Laws, GoOnSmoothlyPastTheirFormulas)
{
  for (const double b : {1.0, 20.0})
  {
    Law law(MaterialModel::exponential, {kYoung, kPoisson, b});
    expectSmoothAcross(law, [&](const Mat3& f) {
      return b * (f.squaredNorm() - 2.0 * f.determinant() - 1.0) - kSteepestExponent;
    });
  }
  Law law(MaterialModel::neo_hookean_log, {kYoung, kPoisson});
  expectSmoothAcross(law, [&](const Mat3& f) { return f.determinant() - kLeastLogVolume; });
}

TEST(Laws, StayFiniteAtWildDeformations)
{
  std::mt19937 random(5);
  for (const MaterialModel model : kMaterialModels)
  {
    Law law(model, {kYoung, kPoisson, 100.0});
    for (const double size : {1e2, 1e4, 1e8})
    {
      for (int k = 0; k < 20; ++k)
      {
        const Mat3 f = randomMatrix(random, size);
        EXPECT_TRUE(std::isfinite(law.energy(f))) << size;
        EXPECT_TRUE(law.stress(f).allFinite()) << size;
        EXPECT_TRUE(law.stiffness(f).allFinite()) << size;
      }
    }
  }
}

/** A law that is polyconvex is stiff against every a b^T: waves have real speeds. */
TEST(Laws, ExponentialIsStableAgainstEveryShear)
{
  std::mt19937 random(6);
  for (const double poisson : {-0.4, 0.0, 0.49})
  {
    Law law(MaterialModel::exponential, {kYoung, poisson, 5.0});
    for (const NamedF& f : deformationGradients())
    {
      const Eigen::MatrixXd stiffness = law.stiffness(f.f);
      for (int k = 0; k < 50; ++k)
      {
        const Mat3 wave = randomMatrix(random, 1.0).col(0) * randomMatrix(random, 1.0).row(0);
        const Eigen::Map<const Eigen::VectorXd> v(wave.data(), 9);
        EXPECT_GT(v.dot(stiffness * v), -1e-12 * stiffness.norm()) << f.name;
      }
    }
  }
}

TEST(CorotatedLaw, IsThatOfItsStretchesHoweverNearTheyCancel)
{
  constexpr double kRounding = 1e-15;
  const Lame lame = lameFrom(kYoung, kPoisson);
  Law law(MaterialModel::corotated, {kYoung, kPoisson});
  std::mt19937 random(11);
  for (const Vec3& s :
       {Vec3(1, 1, 1), Vec3(1.2, 0.7, 0), Vec3(1.2, 0.7, -0.5), Vec3(1.2, 0.7, -0.69),
        Vec3(1.2, 0.7, -0.6999), Vec3(1.2, 0.7, -0.6999999), Vec3(1, 1, -0.99999),
        Vec3(1, 1e-3, 1e-3), Vec3(1, 1e-6, -1e-7), Vec3(1, 0.5, 1e-8), Vec3(1e3, 1e-3, 1e-3),
        Vec3(30, 20, -19), Vec3(1e-4, 1e-5, 1e-5), Vec3(1e9, 1e3, 1), Vec3(1e40, 1e39, 1e38)})
  {
    for (int turn = 0; turn < 20; ++turn)
    {
      const Mat3 u = randomRotation(random), v = randomRotation(random);
      const Mat3 f = u * s.asDiagonal() * v.transpose();
      const Vec3 strain = s - Vec3::Ones();
      const double trace = strain.sum();
      const double energy = lame.mu * strain.squaredNorm() + 0.5 * lame.lambda * trace * trace;
      // Positions are rounded, and how fast the rotation turns with them.
      const double size = 1.0 + s[0], rounded = kRounding * size / (s[1] + s[2]);
      EXPECT_NEAR(law.energy(f), energy, 20.0 * kRounding * kYoung * size * size) << s.transpose();
      const Vec3 force = 2.0 * lame.mu * strain + lame.lambda * trace * Vec3::Ones();
      const Mat3 stress = u * force.asDiagonal() * v.transpose();
      EXPECT_LT((law.stress(f) - stress).norm(), 20.0 * rounded * kYoung * size) << s.transpose();
    }
  }
}

}  // namespace
}  // namespace soft_tissue
