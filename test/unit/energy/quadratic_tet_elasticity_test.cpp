#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "support/finite_difference.h"
#include "support/quadratic_oracle.h"
#include "support/tet_cluster.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 5000.0;

class EveryQuadratic : public ::testing::TestWithParam<std::tuple<MaterialModel, double>>
{
 protected:
  MaterialModel model() const { return std::get<0>(GetParam()); }
  TetStiffnessParameters parameters() const { return {kYoung, std::get<1>(GetParam())}; }
  double scale() const
  {
    const Lame lame = lameFrom(kYoung, std::get<1>(GetParam()));
    return 2.0 * lame.mu + std::abs(lame.lambda);
  }
  QuadraticTetElasticity elementTerm() const { return {mesh_, model(), {parameters()}, 0}; }

  /** Ordinary, degenerate and inverted shapes, F of each point of its own. */
  template <typename Check>
  void forShapes(const Check& check) const
  {
    unsigned seed = 0;
    for (const NamedF& f : deformationGradients())
    {
      const Points x = shaken(mesh_.nodes, f.f, 0.05, ++seed);
      bool smooth = true;
      for (const Barycentric& l : gaussPoints())
      {
        const Mat3 at = quadraticF(mesh_.elements[0], mesh_.nodes, x, l);
        const Vec3 s = at.jacobiSvd().singularValues();
        smooth = smooth && s[1] + std::copysign(s[2], at.determinant()) > 0.1;
      }
      check(f.name, x, smooth || isSmooth(model()));
    }
  }

  QuadraticTetMesh mesh_ = withEdgeNodes(
      {{{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.1, 0}, {0.1, -0.2, 0.9}}, {{2, 0, 1, 3}}, {0}});
  Adjacency neighbours_ = nodeNeighbours(10, mesh_.elements);
};

INSTANTIATE_TEST_SUITE_P(All, EveryQuadratic, ::testing::ValuesIn(lawsAndPoissonRatios()));

TEST_P(EveryQuadratic, IsAtRestUndeformedWhereverItIsTurned)
{
  QuadraticTetElasticity term = elementTerm();
  std::mt19937 random(1);
  for (int k = 0; k < 20; ++k)
  {
    const Mat3 turn = isBlindToRotations(model()) ? randomRotation(random) : Mat3::Identity();
    const Points x = shaken(mesh_.nodes, turn, 0.0, 0);
    EXPECT_NEAR(term.value(x), 0.0, 1e-13 * scale());
    EXPECT_LT(gradientOf(term, x).norm(), 1e-13 * scale());
    EXPECT_NEAR(term.minDetF(x), 1.0, 1e-13);
  }
}

TEST_P(EveryQuadratic, EnergyIsThatOfItsGaussPoints)
{
  QuadraticTetElasticity term = elementTerm();
  forShapes([&](const std::string& name, const Points& x, bool) {
    double energy = 0.0;
    for (const Barycentric& l : gaussPoints())
    {
      const Mat3 f = quadraticF(mesh_.elements[0], mesh_.nodes, x, l);
      energy +=
          0.25 * volumeOf(mesh_.elements[0], mesh_.nodes) * LawAt(model(), parameters(), f).energy;
    }
    EXPECT_NEAR(term.value(x), energy, 1e-12 * (scale() + energy)) << name;
    Points gradient(10, Vec3::Zero());
    EXPECT_NEAR(term.valueAndGradient(x, gradient), energy, 1e-12 * (scale() + energy)) << name;
  });
}

TEST_P(EveryQuadratic, GradientIsTheEnergysDerivative)
{
  QuadraticTetElasticity term = elementTerm();
  double worst = 0.0;
  forShapes([&](const std::string& name, const Points& x, bool smooth) {
    const Eigen::VectorXd gradient = gradientOf(term, x);
    ASSERT_TRUE(gradient.allFinite()) << name;
    if (smooth)
    {
      const double error = (gradient - differenceGradient(term, x, 1e-4)).norm();
      worst = std::max(worst, error / (scale() + gradient.norm()));
      EXPECT_LT(error, 1e-8 * (scale() + gradient.norm())) << name;
    }
  });
  std::printf("  gradient: off its difference by at most %.1e\n", worst);
}

TEST_P(EveryQuadratic, HessianIsTheGradientsDerivative)
{
  QuadraticTetElasticity term = elementTerm();
  double worst = 0.0;
  forShapes([&](const std::string& name, const Points& x, bool smooth) {
    const Eigen::MatrixXd hessian = hessianOf(term, x, neighbours_, Curvature::exact);
    ASSERT_TRUE(hessian.allFinite()) << name;
    const double size = scale() + hessian.norm();
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-14 * size) << name;
    EXPECT_LT((hessian * Eigen::VectorXd::Ones(30)).norm(), 1e-13 * size) << name;
    if (smooth)
    {
      const double error = (hessian - differenceHessian(term, x, 1e-4)).norm();
      worst = std::max(worst, error / size);
      EXPECT_LT(error, 1e-7 * size) << name;
    }
  });
  std::printf("  Hessian: off its difference by at most %.1e\n", worst);
}

TEST_P(EveryQuadratic, ProjectedHessianIsPositiveAtEachGaussPoint)
{
  QuadraticTetElasticity term = elementTerm();
  TetElasticity unit(unitTet(), model(), {parameters()}, 0);
  forShapes([&](const std::string& name, const Points& x, bool smooth) {
    const Eigen::MatrixXd hessian = hessianOf(term, x, neighbours_);
    ASSERT_TRUE(hessian.allFinite()) << name;
    const double size = scale() + hessian.norm();
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-14 * size) << name;
    EXPECT_GT(smallestEigenvalue(hessian), -1e-13 * size) << name;
    if (!smooth)
    {
      return;
    }
    // Nodes 1, 2, 3 of the unit tet are the columns of F: their block is dP/dF / 6.
    const QuadraticTet& n = mesh_.elements[0];
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(30, 30);
    for (const Barycentric& l : gaussPoints())
    {
      const Points at = deformedUnitTet(quadraticF(n, mesh_.nodes, x, l));
      const Eigen::MatrixXd exact =
          hessianOf(unit, at, nodeNeighbours(4, unitTet().tets), Curvature::exact);
      const Eigen::MatrixXd tangent = 6.0 * projected(exact.bottomRightCorner(9, 9));
      const auto gradients = shapeGradients(n, mesh_.nodes, l);
      Eigen::MatrixXd to_f = Eigen::MatrixXd::Zero(9, 30);
      for (int a = 0; a < 10; ++a)
      {
        for (int k = 0; k < 9; ++k)
        {
          to_f(k, 3 * n[a] + k % 3) = gradients(k / 3, a);
        }
      }
      expected += 0.25 * volumeOf(n, mesh_.nodes) * to_f.transpose() * tangent * to_f;
    }
    EXPECT_LT((hessian - expected).norm(), 1e-11 * size) << name;
  });
}

TEST_P(EveryQuadratic, GivesWayOnlyAsARigidBody)
{
  QuadraticTetElasticity term = elementTerm();
  const Eigen::MatrixXd hessian =
      hessianOf(term, shaken(mesh_.nodes, Mat3::Identity(), 0.0, 0), neighbours_, Curvature::exact);
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues();
  std::printf("  eigenvalues %.1e (6th) %.3g (7th) %.3g (30th) N/m\n", values[5], values[6],
              values[29]);
  EXPECT_LT(values.head(6).cwiseAbs().maxCoeff(), 1e-12 * values[29]);
  EXPECT_GT(values[6], 0.01 * lameFrom(kYoung, parameters().poisson_ratio).mu);  // edges of 1 m
}

TEST_P(EveryQuadratic, TellsDetFAndStressWhereItSays)
{
  QuadraticTetElasticity term = elementTerm();
  const QuadraticTet& n = mesh_.elements[0];
  forShapes([&](const std::string& name, const Points& x, bool) {
    std::vector<Barycentric> places = gaussPoints();
    for (int k = 0; k < 4; ++k)
    {
      places.push_back(Barycentric::Unit(k));
    }
    double smallest = 1e300;
    for (const Barycentric& l : places)
    {
      smallest = std::min(smallest, quadraticF(n, mesh_.nodes, x, l).determinant());
    }
    EXPECT_NEAR(term.minDetF(x), smallest, 1e-12 * (1.0 + std::abs(smallest))) << name;
  });
  // Stress in the middle of each part, found among the barycentric coordinates of its nodes.
  const Points x = shaken(mesh_.nodes, Mat3::Identity(), 0.05, 3);
  std::vector<float> stress;
  term.vonMises(x, stress);
  ASSERT_EQ(stress.size(), 8u);
  const TetMesh fine = subdivided(mesh_);
  Mat3 edges;
  edges << mesh_.nodes[n[1]] - mesh_.nodes[n[0]], mesh_.nodes[n[2]] - mesh_.nodes[n[0]],
      mesh_.nodes[n[3]] - mesh_.nodes[n[0]];
  for (int part = 0; part < 8; ++part)
  {
    Vec3 middle = Vec3::Zero();
    for (const Index node : fine.tets[part])
    {
      middle += 0.25 * mesh_.nodes[node];
    }
    Barycentric l;
    l.tail<3>() = edges.inverse() * (middle - mesh_.nodes[n[0]]);
    l[0] = 1.0 - l.tail<3>().sum();
    const double expected =
        LawAt(model(), parameters(), quadraticF(n, mesh_.nodes, x, l)).von_mises;
    EXPECT_NEAR(stress[part], expected, 1e-5 * expected) << part;
  }
}

TEST_P(EveryQuadratic, ReproducesLinearDeformationsOnADistortedMesh)
{
  TetMesh box = makeBox({2, 2, 2}, {2.0, 2.0, 2.0});
  std::mt19937 random(9);
  for (Vec3& p : box.nodes)
  {
    p += 0.2 * randomMatrix(random, 1.0).col(0);
  }
  const QuadraticTetMesh mesh = withEdgeNodes(box);
  const std::vector<TetStiffnessParameters> all(box.tets.size(), parameters());
  QuadraticTetElasticity term(mesh, model(), all, 0);
  TetElasticity linear(box, model(), all, 0);
  const BoundarySurface surface =
      extractBoundary(static_cast<Index>(mesh.nodes.size()), subdivided(mesh).tets);
  for (const NamedF& f : deformationGradients())
  {
    if (!f.smooth)
    {
      continue;
    }
    const Points x = shaken(mesh.nodes, f.f, 0.0, 0);
    const double energy = term.value(x);
    EXPECT_NEAR(energy, linear.value(Points(x.begin(), x.begin() + box.nodes.size())),
                1e-11 * (scale() + energy))
        << f.name;
    const Eigen::VectorXd gradient = gradientOf(term, x);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      if (surface.node_slot[i] < 0)
      {
        EXPECT_LT(gradient.segment<3>(3 * i).norm(), 1e-11 * (scale() + gradient.norm())) << f.name;
      }
    }
    std::vector<float> stress;
    term.vonMises(x, stress);
    const double expected = LawAt(model(), parameters(), f.f).von_mises;
    for (const float s : stress)
    {
      EXPECT_NEAR(s, expected, 1e-5 * (scale() + expected)) << f.name;
    }
  }
}

class QuadraticModel : public ::testing::TestWithParam<MaterialModel>
{
 protected:
  QuadraticModel()
  {
    Points rest = mesh_.nodes;
    x_ = shaken(rest, Mat3::Identity(), 0.1, 5);
    x_.insert(x_.begin(), cluster_.first_node, Vec3::Zero());
    std::vector<QuadraticTet> elements = mesh_.elements;
    for (QuadraticTet& element : elements)
    {
      for (Index& node : element)
      {
        node += cluster_.first_node;
      }
    }
    neighbours_ = nodeNeighbours(static_cast<Index>(x_.size()), elements);
  }

  Cluster cluster_;
  QuadraticTetMesh mesh_ = withEdgeNodes(cluster_.mesh);
  Points x_;
  Adjacency neighbours_;
};

INSTANTIATE_TEST_SUITE_P(All, QuadraticModel, ::testing::ValuesIn(kMaterialModels));

TEST_P(QuadraticModel, AssemblesWhatItsTetsSayOneByOne)
{
  QuadraticTetElasticity all(mesh_, GetParam(), cluster_.parameters, cluster_.first_node);
  double energy = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * x_.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(gradient.size(), gradient.size());
  std::vector<float> stress, stress_of_all;
  all.vonMises(x_, stress_of_all);
  for (std::size_t t = 0; t < mesh_.elements.size(); ++t)
  {
    QuadraticTetMesh one = mesh_;
    one.elements = {mesh_.elements[t]};
    one.tags = {0};
    QuadraticTetElasticity term(one, GetParam(), {cluster_.parameters[t]}, cluster_.first_node);
    energy += term.value(x_);
    gradient += gradientOf(term, x_);
    hessian += hessianOf(term, x_, neighbours_);
    term.vonMises(x_, stress);
    EXPECT_TRUE(std::equal(stress.begin(), stress.end(), stress_of_all.begin() + 8 * t));
  }
  EXPECT_NEAR(all.value(x_), energy, 1e-13 * energy);
  EXPECT_LT((gradientOf(all, x_) - gradient).norm(), 1e-13 * gradient.norm());
  EXPECT_LT((hessianOf(all, x_, neighbours_) - hessian).norm(), 1e-13 * hessian.norm());
  EXPECT_LT((gradient - differenceGradient(all, x_, 1e-4)).norm(), 1e-8 * gradient.norm());
}

TEST_P(QuadraticModel, GivesTheSameBitsOnEveryInstructionSetAndThreadCount)
{
  const InstructionSet best = instructionSet();
  // Enough elements for several chunks of several colours.
  const QuadraticTetMesh box = withEdgeNodes(makeBox({6, 5, 4}, {6.0, 5.0, 4.0}));
  const std::vector<TetStiffnessParameters> stiffness(box.elements.size(), {kYoung, 0.4});
  const Adjacency neighbours = nodeNeighbours(static_cast<Index>(box.nodes.size()), box.elements);
  const Points x = shaken(box.nodes, Mat3::Identity(), 0.2, 8);
  std::vector<std::vector<double>> results;
  for (int set = 0; set <= static_cast<int>(best); ++set)
  {
    for (const int threads : {1, 2})
    {
      setThreadCount(threads);
      forceInstructionSet(static_cast<InstructionSet>(set));
      QuadraticTetElasticity term(box, GetParam(), stiffness, 0);
      std::vector<double> result = {term.value(x), term.minDetF(x)};
      const Eigen::VectorXd gradient = gradientOf(term, x);
      result.insert(result.end(), gradient.data(), gradient.data() + gradient.size());
      for (const Curvature curvature : {Curvature::exact, Curvature::positive})
      {
        BlockMatrix hessian(neighbours);
        term.addHessian(x, curvature, hessian);
        result.insert(result.end(), hessian.values().begin(), hessian.values().end());
      }
      std::vector<float> stress;
      term.vonMises(x, stress);
      result.insert(result.end(), stress.begin(), stress.end());
      results.push_back(result);
    }
  }
  setThreadCount(1);
  forceInstructionSet(best);
  for (const std::vector<double>& result : results)
  {
    EXPECT_TRUE(result == results[0]);
  }
}

TEST(QuadraticTetElasticity, RefusesATetWithoutVolumeAndNodesOutOfOrder)
{
  const auto complaint = [](const QuadraticTetMesh& mesh) -> std::string {
    try
    {
      QuadraticTetElasticity term(mesh, MaterialModel::corotated, {{kYoung, 0.3}}, 0);
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "none";
  };
  TetMesh flat = unitTet();
  flat.nodes[3] = Vec3(0.5, 0.5, 0.0);
  EXPECT_NE(complaint(withEdgeNodes(flat)).find("tet 0 has rest volume"), std::string::npos);
  QuadraticTetMesh swapped = withEdgeNodes(unitTet());
  std::swap(swapped.elements[0][7], swapped.elements[0][8]);
  std::swap(swapped.nodes[7], swapped.nodes[8]);
  EXPECT_NE(complaint(swapped).find("nodes of quadratic tet 0 must ascend"), std::string::npos);
  EXPECT_EQ(complaint(withEdgeNodes(unitTet())), "none");
}

}  // namespace
}  // namespace soft_tissue
