#include "soft_tissue_sim/energy/mass_spring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "support/deformed_tets.h"
#include "support/finite_difference.h"
#include "support/tet_cluster.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 5000.0;
constexpr double kSize = 0.5 * kYoung;  // of stress times volume of the unit tet

/** The rotations of an icosahedron: functions of degree 5 and less have the same mean over them as
 * over all rotations. */
std::vector<Mat3> icosahedralRotations()
{
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  const Mat3 turns[] = {
      Eigen::AngleAxisd(0.4 * M_PI, Vec3(0.0, 1.0, golden).normalized()).toRotationMatrix(),
      Eigen::AngleAxisd(M_PI / 1.5, Vec3(1.0, 1.0, 1.0).normalized()).toRotationMatrix()};
  std::vector<Mat3> all = {Mat3::Identity()};
  for (std::size_t k = 0; k < all.size() && all.size() < 100; ++k)
  {
    for (const Mat3& turn : turns)
    {
      const Mat3 next = turn * all[k];
      const auto same = [&](const Mat3& other) { return (other - next).norm() < 1e-6; };
      if (std::none_of(all.begin(), all.end(), same))
      {
        all.push_back(next);
      }
    }
  }
  return all;
}

/** The formula, edge by edge. */
double obviousEnergy(const TetMesh& rest, const std::vector<TetStiffnessParameters>& parameters,
                     const Points& x)
{
  double sum = 0.0;
  for (std::size_t t = 0; t < rest.tets.size(); ++t)
  {
    const Tet& tet = rest.tets[t];
    const auto volume = [&](const Points& p) {
      return signedVolume6(p[tet[0]], p[tet[1]], p[tet[2]], p[tet[3]]) / 6.0;
    };
    const Lame lame = lameFrom(parameters[t].young_modulus, parameters[t].poisson_ratio);
    const double v = volume(rest.nodes);
    sum += 0.5 * (lame.lambda - lame.mu) * v * std::pow(volume(x) / v - 1.0, 2);
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < i; ++j)
      {
        const double length = (rest.nodes[tet[i]] - rest.nodes[tet[j]]).norm();
        const double stiffness = 2.5 * lame.mu * v / (length * length);
        sum += 0.5 * stiffness * std::pow((x[tet[i]] - x[tet[j]]).norm() - length, 2);
      }
    }
  }
  return sum;
}

class MassSprings : public ::testing::TestWithParam<double>
{
 protected:
  MassSpring unitElement() const { return MassSpring(unitTet(), {{kYoung, GetParam()}}, 0); }
  Adjacency neighbours_ = nodeNeighbours(4, unitTet().tets);
};

INSTANTIATE_TEST_SUITE_P(PoissonRatios, MassSprings, ::testing::Values(0.25, 0.4, 0.49));

TEST_P(MassSprings, HaveTheEnergyOfTheirFormula)
{
  MassSpring term = unitElement();
  for (const NamedF& f : deformationGradients())
  {
    const Points x = deformedUnitTet(f.f);
    double shortest = 1e300;
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < i; ++j)
      {
        shortest = std::min(
            shortest, (x[i] - x[j]).norm() / (unitTet().nodes[i] - unitTet().nodes[j]).norm());
      }
    }
    const double expected = obviousEnergy(unitTet(), {{kYoung, GetParam()}}, x);
    if (shortest > 0.1)
    {
      EXPECT_NEAR(term.value(x), expected, 1e-12 * (kSize + expected)) << f.name;
    }
  }
}

/** So Young's modulus and Poisson's ratio are those of a mesh with edges in all directions. */
TEST_P(MassSprings, FollowHookesLawInTheMeanOverAllWaysTheyAreTurned)
{
  const std::vector<Mat3> turns = icosahedralRotations();
  ASSERT_EQ(turns.size(), 60u);
  MassSpring term = unitElement();
  std::mt19937 random(3);
  const Mat3 h = randomMatrix(random, 1e-6);
  const Mat3 strain = 0.5 * (h + h.transpose());
  const Lame lame = lameFrom(kYoung, GetParam());
  const Mat3 expected = 2.0 * lame.mu * strain + lame.lambda * strain.trace() * Mat3::Identity();
  Mat3 mean = Mat3::Zero();
  for (const Mat3& turn : turns)
  {
    const Mat3 f = Mat3::Identity() + turn.transpose() * h * turn;
    const Eigen::VectorXd gradient = gradientOf(term, deformedUnitTet(f));
    mean += turn * (6.0 * Eigen::Map<const Mat3>(gradient.data() + 3)) * turn.transpose() / 60.0;
  }
  EXPECT_LT((mean - expected).norm(), 1e-5 * expected.norm());
}

TEST_P(MassSprings, EnergyDoesNotSeeRotationsAndForcesBalance)
{
  MassSpring term = unitElement();
  std::mt19937 random(2);
  for (const NamedF& f : deformationGradients())
  {
    const Points x = deformedUnitTet(f.f);
    const double energy = term.value(x);
    EXPECT_NEAR(term.value(deformedUnitTet(randomRotation(random) * f.f)), energy,
                1e-12 * (kSize + energy))
        << f.name;
    Points gradient(4, Vec3::Zero());
    EXPECT_NEAR(term.valueAndGradient(x, gradient), energy, 1e-15 * energy);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double size = kSize;
    for (int node = 0; node < 4; ++node)
    {
      force += gradient[node];
      moment += x[node].cross(gradient[node]);
      size += gradient[node].norm() * (1.0 + x[node].norm());
    }
    EXPECT_LT(force.norm(), 1e-13 * size) << f.name;
    EXPECT_LT(moment.norm(), 1e-13 * size) << f.name;
  }
}

TEST_P(MassSprings, GradientAndHessianAreDerivatives)
{
  MassSpring term = unitElement();
  double worst[2] = {0.0, 0.0};
  for (const NamedF& f : deformationGradients())
  {
    const Points x = deformedUnitTet(f.f);
    const Eigen::VectorXd gradient = gradientOf(term, x);
    const Eigen::MatrixXd hessian = hessianOf(term, x, neighbours_, Curvature::exact);
    const double off[] = {
        (gradient - differenceGradient(term, x, 1e-4)).norm() / (kSize + gradient.norm()),
        (hessian - differenceHessian(term, x, 1e-4)).norm() / (kSize + hessian.norm())};
    EXPECT_LT(off[0], 1e-8) << f.name;
    EXPECT_LT(off[1], 1e-7) << f.name;
    worst[0] = std::max(worst[0], off[0]);
    worst[1] = std::max(worst[1], off[1]);
  }
  std::printf("  off their differences by at most %.1e, %.1e\n", worst[0], worst[1]);
}

TEST_P(MassSprings, PositiveHessianIsPositiveAndExactAtRest)
{
  MassSpring term = unitElement();
  for (const NamedF& f : deformationGradients())
  {
    const Eigen::MatrixXd hessian = hessianOf(term, deformedUnitTet(f.f), neighbours_);
    EXPECT_GT(smallestEigenvalue(hessian), -1e-13 * (kSize + hessian.norm())) << f.name;
  }
  const Eigen::MatrixXd at_rest = hessianOf(term, unitTet().nodes, neighbours_);
  const Eigen::MatrixXd exact = hessianOf(term, unitTet().nodes, neighbours_, Curvature::exact);
  EXPECT_LT((at_rest - exact).norm(), 1e-13 * exact.norm());
}

/** The positive part of a single spring is that of its eigenvalues. */
TEST(MassSpring, ProjectsEachSpring)
{
  for (const double length : {0.0, 0.05, 0.5, 0.999, 1.5})
  {
    // Far away nodes 2 and 3 pull along x and y almost alone: what is compared is block (0, 1).
    Points x = unitTet().nodes;
    x[1] = Vec3(length, 0.0, 0.0);
    MassSpring term(unitTet(), {{kYoung, 0.25}}, 0);
    const Adjacency neighbours = nodeNeighbours(4, unitTet().tets);
    const Mat3 exact = -hessianOf(term, x, neighbours, Curvature::exact).block<3, 3>(0, 3);
    const Mat3 positive = -hessianOf(term, x, neighbours).block<3, 3>(0, 3);
    EXPECT_LT((positive - projected(exact)).norm(), 1e-12 * kSize) << length;
  }
}

TEST(MassSpring, StaysFiniteAtWildDeformations)
{
  MassSpring term(unitTet(), {{kYoung, 0.45}}, 0);
  const Adjacency neighbours = nodeNeighbours(4, unitTet().tets);
  std::mt19937 random(5);
  for (const double size : {0.0, 1e-12, 1e-3, 1e2, 1e4, 1e8})
  {
    for (int k = 0; k < 20; ++k)
    {
      const Points x = deformedUnitTet(randomMatrix(random, size));
      EXPECT_TRUE(std::isfinite(term.value(x))) << size;
      EXPECT_TRUE(gradientOf(term, x).allFinite()) << size;
      for (const Curvature curvature : {Curvature::exact, Curvature::positive})
      {
        EXPECT_TRUE(hessianOf(term, x, neighbours, curvature).allFinite()) << size;
      }
    }
  }
}

/** Where a spring gets short its law goes on with the same value, slope and curvature. */
TEST(MassSpring, IsSmoothWhereSpringsGetShort)
{
  MassSpring term(unitTet(), {{kYoung, 0.25}}, 0);
  const Adjacency neighbours = nodeNeighbours(4, unitTet().tets);
  const auto at = [](double length) {
    Points x = unitTet().nodes;
    x[1] = Vec3(length, 0.0, 0.0);
    return x;
  };
  const double step = 1e-9;
  const Points before = at(0.1 - step), after = at(0.1 + step);
  EXPECT_NEAR(term.value(before), term.value(after), 1e-7 * kSize);
  EXPECT_LT((gradientOf(term, before) - gradientOf(term, after)).norm(), 1e-7 * kSize);
  const Eigen::MatrixXd k = hessianOf(term, before, neighbours, Curvature::exact);
  const Eigen::MatrixXd l = hessianOf(term, after, neighbours, Curvature::exact);
  EXPECT_LT((k - l).norm(), 1e-6 * k.norm());
}

std::vector<TetStiffnessParameters> withSprings(std::vector<TetStiffnessParameters> parameters)
{
  for (TetStiffnessParameters& p : parameters)
  {
    p.poisson_ratio = 0.25 + 0.1 * std::abs(p.poisson_ratio);
  }
  return parameters;
}

TEST(MassSpring, AddsUpWhatItsTetsSayAndKnowsEachEdgeOnce)
{
  const Cluster cluster;
  const std::vector<TetStiffnessParameters> parameters = withSprings(cluster.parameters);
  MassSpring all(cluster.mesh, parameters, cluster.first_node);
  const Adjacency neighbours = cluster.neighbours();
  EXPECT_EQ(2 * all.springCount(),
            nodeNeighbours(static_cast<Index>(cluster.mesh.nodes.size()), cluster.mesh.tets)
                .items.size());
  double energy = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * cluster.x.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  for (std::size_t t = 0; t < cluster.mesh.tets.size(); ++t)
  {
    TetMesh one = cluster.mesh;
    one.tets = {cluster.mesh.tets[t]};
    one.tags = {0};
    MassSpring term(one, {parameters[t]}, cluster.first_node);
    energy += term.value(cluster.x);
    gradient += gradientOf(term, cluster.x);
    hessian += hessianOf(term, cluster.x, neighbours, Curvature::exact);
  }
  EXPECT_NEAR(all.value(cluster.x), energy, 1e-13 * energy);
  EXPECT_LT((gradientOf(all, cluster.x) - gradient).norm(), 1e-13 * gradient.norm());
  EXPECT_LT((hessianOf(all, cluster.x, neighbours, Curvature::exact) - hessian).norm(),
            1e-13 * hessian.norm());
}

TEST(MassSpring, GivesTheSameBitsOnAnyThreadCount)
{
  const TetMesh mesh = makeBox({7, 6, 8}, {0.7, 0.6, 0.8});
  const Adjacency neighbours = nodeNeighbours(static_cast<Index>(mesh.nodes.size()), mesh.tets);
  const std::vector<TetStiffnessParameters> parameters(mesh.tets.size(), {kYoung, 0.4});
  std::mt19937 random(8);
  Points x = mesh.nodes;
  for (Vec3& p : x)
  {
    p += randomMatrix(random, 0.02).col(0);
  }
  std::vector<BlockMatrix> hessians;
  std::vector<Points> gradients;
  std::vector<double> energies;
  for (const int threads : {1, 2, 3})
  {
    setThreadCount(threads);
    MassSpring term(mesh, parameters, 0);
    hessians.emplace_back(neighbours);
    term.addHessian(x, Curvature::exact, hessians.back());
    gradients.emplace_back(x.size(), Vec3::Zero());
    energies.push_back(term.valueAndGradient(x, gradients.back()));
  }
  setThreadCount(1);
  for (std::size_t k = 1; k < energies.size(); ++k)
  {
    EXPECT_EQ(hessians[k].values(), hessians[0].values());
    EXPECT_EQ(gradients[k], gradients[0]);
    EXPECT_EQ(energies[k], energies[0]);
  }
}

TEST(MassSpring, TellsDetFAndTheStressOfItsForces)
{
  const Cluster cluster;
  MassSpring springs(cluster.mesh, withSprings(cluster.parameters), cluster.first_node);
  TetElasticity solid(cluster.mesh, MaterialModel::neo_hookean, cluster.parameters,
                      cluster.first_node);
  EXPECT_NEAR(springs.minDetF(cluster.x), solid.minDetF(cluster.x), 1e-10);

  MassSpring term(unitTet(), {{kYoung, 0.45}}, 0);
  for (const NamedF& f : deformationGradients())
  {
    const double j = f.f.determinant();
    if (std::abs(j) < 0.01)
    {
      continue;
    }
    const Points x = deformedUnitTet(f.f);
    const Eigen::VectorXd gradient = gradientOf(term, x);
    Mat3 stress = 6.0 * Eigen::Map<const Mat3>(gradient.data() + 3) * f.f.transpose() / std::abs(j);
    stress.diagonal().array() -= stress.trace() / 3.0;
    const double expected = std::sqrt(1.5) * stress.norm();
    std::vector<float> found;
    term.vonMises(x, found);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0], expected, 1e-6 * (kYoung + expected)) << f.name;
  }
}

std::string complaint(const TetMesh& mesh, const TetStiffnessParameters& parameters)
{
  try
  {
    MassSpring term(mesh, {parameters}, 0);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "accepted";
}

TEST(MassSpring, RefusesWhatSpringsCannotHave)
{
  TetMesh flat = unitTet();
  flat.nodes[3] = Vec3(0.5, 0.5, 0.0);
  EXPECT_NE(complaint(flat, {kYoung, 0.3}).find("tet 0 has rest volume"), std::string::npos);
  EXPECT_NE(complaint(unitTet(), {kYoung, 0.2}).find("poisson_ratio 0.2"), std::string::npos);
  EXPECT_NE(complaint(unitTet(), {kYoung, 0.5}).find("[0.25, 0.5)"), std::string::npos);
  EXPECT_NE(complaint(unitTet(), {0.0, 0.3}).find("young_modulus 0"), std::string::npos);
}

}  // namespace
}  // namespace soft_tissue
