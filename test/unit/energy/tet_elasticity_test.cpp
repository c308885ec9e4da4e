#include "soft_tissue_sim/energy/tet_elasticity.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "support/deformed_tets.h"
#include "support/finite_difference.h"
#include "support/tet_cluster.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 5000.0;

class EveryMaterial : public ::testing::TestWithParam<std::tuple<MaterialModel, double>>
{
 protected:
  MaterialModel model() const { return std::get<0>(GetParam()); }
  double poisson() const { return std::get<1>(GetParam()); }
  /** Size of stress the numbers below are relative to. */
  double scale() const
  {
    const Lame lame = lameFrom(kYoung, poisson());
    return 2.0 * lame.mu + std::abs(lame.lambda);
  }
  TetElasticity unitElement() const
  {
    return TetElasticity(unitTet(), model(), {{kYoung, poisson()}}, 0);
  }
  Adjacency neighbours_ = nodeNeighbours(4, unitTet().tets);
};

INSTANTIATE_TEST_SUITE_P(All, EveryMaterial, ::testing::ValuesIn(lawsAndPoissonRatios()));

TEST_P(EveryMaterial, IsAtRestUndeformedWhereverItIsTurned)
{
  TetElasticity term = unitElement();
  std::mt19937 random(1);
  for (int k = 0; k < 20; ++k)
  {
    const bool turned = k > 0;
    const Points x = deformedUnitTet(turned ? randomRotation(random) : Mat3::Identity());
    if (turned && !isBlindToRotations(model()))
    {
      EXPECT_GT(gradientOf(term, x).norm(), 1e-3 * scale());
      continue;
    }
    EXPECT_NEAR(term.value(x), 0.0, 1e-13 * scale());
    EXPECT_LT(gradientOf(term, x).norm(), 1e-13 * scale());
  }
}

TEST_P(EveryMaterial, EnergyDoesNotSeeRotations)
{
  TetElasticity term = unitElement();
  std::mt19937 random(2);
  double most = 0.0;  // what a rotation changes
  for (const NamedF& f : deformationGradients())
  {
    const double energy = term.value(deformedUnitTet(f.f));
    const double small = 1e-12 * (scale() + energy);
    const Mat3 turn = randomRotation(random);
    const double turned = term.value(deformedUnitTet(turn * f.f));
    const double turned_before = term.value(deformedUnitTet(f.f * turn));
    const double axes_turned = term.value(deformedUnitTet(turn * f.f * turn.transpose()));
    EXPECT_NEAR(axes_turned, energy, small) << f.name;
    most = std::max(
        {most, std::abs(turned - energy) / small, std::abs(turned_before - energy) / small});
  }
  if (isBlindToRotations(model()))
  {
    EXPECT_LT(most, 1.0);
  }
  else
  {
    EXPECT_GT(most, 1e9);
  }
}

TEST_P(EveryMaterial, GradientIsTheEnergysDerivative)
{
  TetElasticity term = unitElement();
  double worst = 0.0;
  for (const NamedF& f : deformationGradients())
  {
    const Points x = deformedUnitTet(f.f);
    const Eigen::VectorXd gradient = gradientOf(term, x);
    ASSERT_TRUE(gradient.allFinite()) << f.name;
    if (f.smooth || isSmooth(model()))
    {
      const double error = (gradient - differenceGradient(term, x, 1e-4)).norm();
      worst = std::max(worst, error / (scale() + gradient.norm()));
      EXPECT_LT(error, 1e-8 * (scale() + gradient.norm())) << f.name;
    }
  }
  std::printf("  gradient: off its difference by at most %.1e\n", worst);
}

TEST_P(EveryMaterial, HessianIsTheGradientsDerivative)
{
  TetElasticity term = unitElement();
  double worst = 0.0;
  for (const NamedF& f : deformationGradients())
  {
    const Points x = deformedUnitTet(f.f);
    const Eigen::MatrixXd hessian = hessianOf(term, x, neighbours_, Curvature::exact);
    ASSERT_TRUE(hessian.allFinite()) << f.name;
    const double size = scale() + hessian.norm();
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-14 * size) << f.name;
    EXPECT_LT((hessian * Eigen::VectorXd::Ones(12)).norm(), 1e-13 * size) << f.name;
    if (f.smooth || isSmooth(model()))
    {
      const double error = (hessian - differenceHessian(term, x, 1e-4)).norm();
      worst = std::max(worst, error / size);
      EXPECT_LT(error, 1e-7 * size) << f.name;
    }
  }
  std::printf("  Hessian: off its difference by at most %.1e\n", worst);
}

TEST_P(EveryMaterial, ProjectedHessianIsThePositivePart)
{
  TetElasticity term = unitElement();
  for (const NamedF& f : deformationGradients())
  {
    const Points x = deformedUnitTet(f.f);
    const Eigen::MatrixXd hessian = hessianOf(term, x, neighbours_);
    ASSERT_TRUE(hessian.allFinite()) << f.name;
    const double size = scale() + hessian.norm();
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-14 * size) << f.name;
    EXPECT_GT(smallestEigenvalue(hessian), -1e-13 * size) << f.name;
    // A common translation of all nodes meets no resistance.
    EXPECT_LT((hessian * Eigen::VectorXd::Ones(12)).norm(), 1e-13 * size) << f.name;
    if (f.smooth || isSmooth(model()))
    {
      // Nodes 1, 2, 3 of the unit tet are the columns of F: their block is V dP/dF itself.
      const Eigen::MatrixXd exact =
          hessianOf(term, x, neighbours_, Curvature::exact).bottomRightCorner(9, 9);
      EXPECT_LT((hessian.bottomRightCorner(9, 9) - projected(exact)).norm(), 1e-12 * size)
          << f.name;
    }
  }
}

TEST_P(EveryMaterial, SmallStrainsFollowHookesLaw)
{
  TetElasticity term = unitElement();
  const Lame lame = lameFrom(kYoung, poisson());
  std::mt19937 random(3);
  const Mat3 h = randomMatrix(random, 1e-6);
  const Mat3 strain = 0.5 * (h + h.transpose());
  const Mat3 stress = 2.0 * lame.mu * strain + lame.lambda * strain.trace() * Mat3::Identity();
  const Eigen::VectorXd gradient = gradientOf(term, deformedUnitTet(Mat3::Identity() + h));
  for (int node = 1; node < 4; ++node)
  {
    const Vec3 force = gradient.segment<3>(3 * node);
    EXPECT_LT((force - stress.col(node - 1) / 6.0).norm(), 1e-5 * stress.norm());
  }
}

TEST_P(EveryMaterial, ForcesBalanceInSumAndMoment)
{
  TetElasticity term = unitElement();
  for (const NamedF& f : deformationGradients())
  {
    const Points x = deformedUnitTet(f.f);
    Points gradient(4, Vec3::Zero());
    term.addGradient(x, gradient);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0.1 * scale();
    for (int node = 0; node < 4; ++node)
    {
      force += gradient[node];
      moment += x[node].cross(gradient[node]);
      size += gradient[node].norm() * (1.0 + x[node].norm());
    }
    EXPECT_LT(force.norm(), 1e-13 * size) << f.name;
    if (isBlindToRotations(model()))
    {
      EXPECT_LT(moment.norm(), 1e-12 * size) << f.name;
    }
  }
}

TEST_P(EveryMaterial, HugeAndTinyElementsStayFinite)
{
  for (const double size : {1e-5, 1e3})
  {
    TetMesh mesh = unitTet();
    for (Vec3& p : mesh.nodes)
    {
      p *= size;
    }
    TetElasticity term(mesh, model(), {{kYoung, poisson()}}, 0);
    for (const NamedF& f : deformationGradients())
    {
      Points x = deformedUnitTet(f.f);
      for (Vec3& p : x)
      {
        p *= size;
      }
      EXPECT_TRUE(std::isfinite(term.value(x))) << f.name;
      EXPECT_TRUE(gradientOf(term, x).allFinite()) << f.name;
      EXPECT_TRUE(hessianOf(term, x, neighbours_).allFinite()) << f.name;
      EXPECT_NEAR(term.minDetF(x), f.f.determinant(), 1e-9 * (1.0 + std::abs(f.f.determinant())));
    }
  }
}

class EveryModel : public ::testing::TestWithParam<MaterialModel>
{};

INSTANTIATE_TEST_SUITE_P(All, EveryModel, ::testing::ValuesIn(kMaterialModels));

TEST_P(EveryModel, AssemblesWhatItsTetsSayOneByOne)
{
  Cluster cluster;
  TetElasticity all(cluster.mesh, GetParam(), cluster.parameters, cluster.first_node);
  const Adjacency neighbours = cluster.neighbours();
  double energy = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * cluster.x.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (std::size_t t = 0; t < cluster.mesh.tets.size(); ++t)
  {
    TetMesh one = cluster.mesh;
    one.tets = {cluster.mesh.tets[t]};
    one.tags = {0};
    TetElasticity term(one, GetParam(), {cluster.parameters[t]}, cluster.first_node);
    energy += term.value(cluster.x);
    gradient += gradientOf(term, cluster.x);
    hessian += hessianOf(term, cluster.x, neighbours);
  }
  EXPECT_NEAR(all.value(cluster.x), energy, 1e-13 * energy);
  EXPECT_LT((gradientOf(all, cluster.x) - gradient).norm(), 1e-13 * gradient.norm());
  EXPECT_LT((hessianOf(all, cluster.x, neighbours) - hessian).norm(), 1e-13 * hessian.norm());
  EXPECT_LT((gradient - differenceGradient(all, cluster.x, 1e-4)).norm(), 1e-8 * gradient.norm());
}

TEST_P(EveryModel, GivesTheSameBitsOnEveryInstructionSetAndThreadCount)
{
  const InstructionSet best = instructionSet();
  Cluster cluster;
  const Adjacency neighbours = cluster.neighbours();
  std::vector<Eigen::MatrixXd> results;
  for (int set = 0; set <= static_cast<int>(best); ++set)
  {
    for (const int threads : {1, 2})
    {
      setThreadCount(threads);
      forceInstructionSet(static_cast<InstructionSet>(set));
      TetElasticity term(cluster.mesh, GetParam(), cluster.parameters, cluster.first_node);
      const Eigen::Index size = 3 * static_cast<Eigen::Index>(cluster.x.size());
      Eigen::MatrixXd result(size, 2 * size + 2);
      result.leftCols(size) = hessianOf(term, cluster.x, neighbours, Curvature::exact);
      result.middleCols(size, size) = hessianOf(term, cluster.x, neighbours, Curvature::positive);
      result.col(2 * size) = gradientOf(term, cluster.x);
      result.col(2 * size + 1).setConstant(term.value(cluster.x));
      results.push_back(result);
    }
  }
  setThreadCount(1);
  forceInstructionSet(best);
  for (const Eigen::MatrixXd& result : results)
  {
    EXPECT_TRUE(result == results[0]);
  }
}

TEST(TetElasticity, VonMisesOfUniaxialStretchIsTheAxialStress)
{
  const double s = 1.2;
  TetElasticity term(unitTet(), MaterialModel::corotated, {{kYoung, 0.0}}, 0);
  std::vector<float> stress;
  term.vonMises(deformedUnitTet(Vec3(s, 1.0, 1.0).asDiagonal().toDenseMatrix()), stress);
  ASSERT_EQ(stress.size(), 1u);
  // nu = 0: P11 = E (s - 1), Cauchy stress P11 s / J with J = s.
  EXPECT_NEAR(stress[0], kYoung * (s - 1.0), 1e-4 * kYoung);
}

TEST(TetElasticity, RefusesATetWithoutVolume)
{
  TetMesh flat = unitTet();
  flat.nodes[3] = Vec3(0.5, 0.5, 0.0);
  try
  {
    TetElasticity term(flat, MaterialModel::corotated, {{kYoung, 0.3}}, 0);
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("tet 0 has rest volume"), std::string::npos);
  }
}

}  // namespace
}  // namespace soft_tissue
