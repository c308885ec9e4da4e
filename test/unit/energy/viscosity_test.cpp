#include "soft_tissue_sim/energy/viscosity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "support/finite_difference.h"
#include "support/quadratic_oracle.h"
#include "support/tet_cluster.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 5000.0;
constexpr double kStep = 0.01;  // s
const std::vector<RelaxationBranch> kSeries = {{0.7, 0.03}, {1.9, 0.4}};

enum class Kind
{
  linear,
  quadratic,
};

/** One tet, linear or quadratic, of a law and its viscosity. */
class ViscousTet
{
 public:
  ViscousTet(MaterialModel model, Kind kind, const ViscosityParameters& viscosity)
  {
    const TetMesh tet = {
        {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.1, 0}, {0.1, -0.2, 0.9}}, {{2, 0, 1, 3}}, {0}};
    const QuadraticTetMesh mesh = withEdgeNodes(tet);
    const std::vector<TetStiffnessParameters> parameters = {{kYoung, 0.3, 0.5}};
    if (kind == Kind::quadratic)
    {
      rest = mesh.nodes;
      law = std::make_unique<QuadraticTetElasticity>(mesh, model, parameters, 0);
      neighbours = nodeNeighbours(10, mesh.elements);
    }
    else
    {
      rest = tet.nodes;
      law = std::make_unique<TetElasticity>(tet, model, parameters, 0);
      neighbours = nodeNeighbours(4, tet.tets);
    }
    memory = std::make_unique<Viscosity>(*law, parameters, viscosity);
  }

  Points under(const Mat3& f) const { return shaken(rest, f, 0.0, 0); }
  Points shakenUnder(const Mat3& f, unsigned seed) const { return shaken(rest, f, 0.05, seed); }

  void step(const Points& from, const Points& to)
  {
    memory->beginStep(from, kStep);
    memory->endStep(to);
  }

  Eigen::VectorXd forces(const Points& x) { return gradientOf(*law, x) + gradientOf(*memory, x); }

  Points rest;
  std::unique_ptr<Elasticity> law;
  std::unique_ptr<Viscosity> memory;
  Adjacency neighbours;
};

/** Each node's force turned. */
Eigen::VectorXd turned(const Mat3& r, const Eigen::VectorXd& forces)
{
  Eigen::VectorXd all = forces;
  for (Eigen::Index k = 0; k < all.size(); k += 3)
  {
    all.segment<3>(k) = r * forces.segment<3>(k);
  }
  return all;
}

class EveryViscosity : public ::testing::TestWithParam<std::tuple<MaterialModel, Kind>>
{
 protected:
  ViscousTet tet(const ViscosityParameters& viscosity) const
  {
    return {std::get<0>(GetParam()), std::get<1>(GetParam()), viscosity};
  }
  MaterialModel model() const { return std::get<0>(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(All, EveryViscosity,
                         ::testing::Combine(::testing::ValuesIn(kMaterialModels),
                                            ::testing::Values(Kind::linear, Kind::quadratic)));

TEST_P(EveryViscosity, HasTheDerivativesOfItsValue)
{
  ViscousTet tet = this->tet({0.02, kSeries});
  std::mt19937 random(3);
  unsigned seed = 0;
  for (const NamedF& f : deformationGradients())
  {
    const Points before = tet.shakenUnder(stretched(random, 1.3, 0.9, 0.7), ++seed);
    tet.step(tet.rest, before);
    tet.memory->beginStep(before, kStep);
    const Points x = tet.shakenUnder(f.f, ++seed);
    const Eigen::VectorXd gradient = gradientOf(*tet.memory, x);
    const double size = kYoung + gradient.norm();
    EXPECT_LT((gradient - differenceGradient(*tet.memory, x, 1e-4)).norm(), 1e-8 * size) << f.name;
    const Eigen::MatrixXd exact = hessianOf(*tet.memory, x, tet.neighbours, Curvature::exact);
    const Eigen::MatrixXd positive = hessianOf(*tet.memory, x, tet.neighbours);
    EXPECT_LT((exact - differenceHessian(*tet.memory, x, 1e-3)).norm(), 1e-8 * exact.norm());
    EXPECT_GT(smallestEigenvalue(positive), -1e-13 * positive.norm()) << f.name;
    EXPECT_GT(smallestEigenvalue(positive - exact), -1e-13 * exact.norm()) << f.name;
    Points sum(x.size(), Vec3::Zero());
    EXPECT_EQ(tet.memory->valueAndGradient(x, sum), tet.memory->value(x));
  }
}

/** A strain that comes in one step and stays: what each branch has then decays with its time. */
TEST_P(EveryViscosity, StressOfAHeldStrainRelaxesAsTheSeriesSays)
{
  ViscousTet tet = this->tet({0.0, kSeries});
  std::mt19937 random(4);
  Points x = tet.shakenUnder(stretched(random, 1.3, 0.9, 0.8), 1);
  double tolerance = 1e-12;
  if (!isBlindToRotations(model()))
  {
    x = tet.under(Mat3::Identity() + randomMatrix(random, 1e-7));  // it is for such strains only
    tolerance = 1e-6;
  }
  const Eigen::VectorXd elastic = gradientOf(*tet.law, x);
  tet.memory->beginStep(tet.rest, kStep);
  for (int k = 0; k < 60; ++k)
  {
    double expected = 1.0;
    for (const RelaxationBranch& b : kSeries)
    {
      const double ramp = (1.0 - std::exp(-kStep / b.relaxation_time)) * b.relaxation_time / kStep;
      expected += b.relative_modulus * ramp * std::exp(-kStep * k / b.relaxation_time);
    }
    const Eigen::VectorXd forces = tet.forces(x);
    EXPECT_LT((forces - expected * elastic).norm(), tolerance * forces.norm()) << k;
    tet.memory->endStep(x);
    tet.memory->beginStep(x, kStep);
  }
  tet.memory->forget();
  tet.memory->beginStep(tet.rest, kStep);
  EXPECT_LT(gradientOf(*tet.memory, tet.rest).norm(), 1e-13 * kYoung);
}

TEST_P(EveryViscosity, RelaxesTheSameWhenTurned)
{
  if (!isBlindToRotations(model()))
  {
    GTEST_SKIP() << "the law itself is not";
  }
  ViscousTet still = tet({0.01, kSeries}), spun = tet({0.01, kSeries});
  std::mt19937 random(5);
  const Points x = still.shakenUnder(stretched(random, 1.2, 1.1, 0.7), 2);
  Points from = still.rest, from_spun = still.rest;
  for (int k = 0; k < 10; ++k)
  {
    const Mat3 r = randomRotation(random);
    Points to_spun;
    for (const Vec3& p : x)
    {
      to_spun.push_back(r * p + Vec3(0.1, 0.2, 0.3));
    }
    still.memory->beginStep(from, kStep);
    spun.memory->beginStep(from_spun, kStep);
    const Eigen::VectorXd expected = turned(r, still.forces(x)), forces = spun.forces(to_spun);
    EXPECT_LT((forces - expected).norm(), 1e-11 * expected.norm());
    still.memory->endStep(x);
    spun.memory->endStep(to_spun);
    from = x;
    from_spun = to_spun;
  }
}

TEST_P(EveryViscosity, DampsNoRigidMotionAndTurnsNothing)
{
  ViscousTet tet = this->tet({0.05, {}});
  std::mt19937 random(6);
  for (const NamedF& f : deformationGradients())
  {
    const Points x = tet.shakenUnder(f.f, 3);
    tet.memory->beginStep(x, kStep);
    const Mat3 r = randomRotation(random);
    Points rigid, other;
    for (const Vec3& p : x)
    {
      rigid.push_back(r * p + Vec3(1.0, -2.0, 0.5));
      other.push_back(p + 0.1 * randomMatrix(random, 1.0).col(0));
    }
    const double size = 5.0 * kYoung * (1.0 + std::pow(f.f.norm(), 3));
    EXPECT_LT(gradientOf(*tet.memory, rigid).norm(), 1e-13 * size) << f.name;
    EXPECT_NEAR(tet.memory->value(rigid), 0.0, 1e-13 * size) << f.name;
    EXPECT_GT(tet.memory->value(other), 0.0) << f.name;
    const Eigen::VectorXd gradient = gradientOf(*tet.memory, other);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (std::size_t i = 0; i < other.size(); ++i)
    {
      force += gradient.segment<3>(3 * i);
      moment += other[i].cross(Vec3(gradient.segment<3>(3 * i)));
    }
    EXPECT_LT(force.norm() + moment.norm(), 1e-12 * gradient.norm()) << f.name;
  }
}

/** At small strain damping is the stiffness matrix times the velocity. */
TEST_P(EveryViscosity, DampingIsProportionalToTheStiffness)
{
  ViscousTet tet = this->tet({0.05, {}});
  std::mt19937 random(7);
  Points from = tet.rest, to = tet.rest;
  Eigen::VectorXd velocity(3 * from.size());
  for (std::size_t i = 0; i < from.size(); ++i)
  {
    const Vec3 move = randomMatrix(random, 1e-7).col(0);
    velocity.segment<3>(3 * i) = move / kStep;
    to[i] += move;
  }
  tet.memory->beginStep(from, kStep);
  const Eigen::MatrixXd stiffness = hessianOf(*tet.law, tet.rest, tet.neighbours, Curvature::exact);
  const Eigen::VectorXd expected = 0.05 * stiffness * velocity;
  EXPECT_LT((gradientOf(*tet.memory, to) - expected).norm(), 1e-5 * expected.norm());
}

/** Strain that grows evenly: S' t of the law, and of each branch S' g t_i (1 - exp(-t / t_i)). */
TEST(Viscosity, StressOfAnEvenStrainRateIsExact)
{
  for (const double slower : {1.0, 10.0})
  {
    ViscousTet tet(MaterialModel::st_venant_kirchhoff, Kind::linear, {0.0, kSeries});
    const Mat3 rate = Vec3(2.0, -0.8, 0.3).asDiagonal().toDenseMatrix() / slower;  // of strain, 1/s
    const auto at = [&](double t) -> Points {
      return tet.under((Mat3::Identity() + 2.0 * t * rate).diagonal().cwiseSqrt().asDiagonal());
    };
    double t = 0.0;
    for (int k = 0; k < 10; ++k)
    {
      tet.memory->beginStep(at(t), kStep);
      t += kStep;
      double expected = 1.0;
      for (const RelaxationBranch& b : kSeries)
      {
        expected +=
            b.relative_modulus * b.relaxation_time / t * (1.0 - std::exp(-t / b.relaxation_time));
      }
      const Points x = at(t);
      ViscousTet elastic(MaterialModel::st_venant_kirchhoff, Kind::linear, {0.0, {}});
      const Eigen::VectorXd wanted = expected * gradientOf(*elastic.law, x);
      EXPECT_LT((tet.forces(x) - wanted).norm(), 1e-12 * wanted.norm()) << t;
      tet.memory->endStep(x);
    }
  }
}

TEST(Viscosity, StaysFiniteWhereTetsWereFlat)
{
  for (const MaterialModel model : kMaterialModels)
  {
    ViscousTet tet(model, Kind::linear, {0.01, kSeries});
    const Eigen::VectorXd usual = gradientOf(*tet.law, tet.under(Vec3(1.5, 0.7, 0.6).asDiagonal()));
    for (const NamedF& f : deformationGradients())
    {
      tet.memory->forget();
      tet.step(tet.rest, tet.under(f.f));
      tet.memory->beginStep(tet.under(f.f), kStep);
      const Points x = tet.under(Vec3(1.5, 0.7, 0.6).asDiagonal());
      EXPECT_LT(gradientOf(*tet.memory, x).norm(), 1e5 * usual.norm()) << f.name;
    }
  }
}

TEST(Viscosity, GivesTheSameBitsOnEveryInstructionSetAndThreadCount)
{
  const InstructionSet best = instructionSet();
  Cluster cluster;
  const QuadraticTetMesh mesh = withEdgeNodes(cluster.mesh);
  Points x = shaken(mesh.nodes, Mat3::Identity(), 0.1, 5);
  x.insert(x.begin(), cluster.first_node, Vec3::Zero());
  std::vector<std::vector<double>> results;
  for (int set = 0; set <= static_cast<int>(best); ++set)
  {
    for (const int threads : {1, 2})
    {
      setThreadCount(threads);
      forceInstructionSet(static_cast<InstructionSet>(set));
      QuadraticTetElasticity law(mesh, MaterialModel::exponential, cluster.parameters,
                                 cluster.first_node);
      Viscosity memory(law, cluster.parameters, {0.01, kSeries});
      Points from = mesh.nodes;
      from.insert(from.begin(), cluster.first_node, Vec3::Zero());
      memory.beginStep(from, kStep);
      memory.endStep(x);
      memory.beginStep(x, kStep);
      std::vector<double> result = memory.memory();
      result.push_back(memory.value(from));
      const Eigen::VectorXd gradient = gradientOf(memory, from);
      result.insert(result.end(), gradient.data(), gradient.data() + gradient.size());
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

}  // namespace
}  // namespace soft_tissue
