#include "soft_tissue_sim/energy/nodal_pressure_elasticity.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/parallel.h"
#include "soft_tissue_sim/energy/viscosity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "support/deformed_tets.h"
#include "support/finite_difference.h"
#include "support/nodal_pressure_oracle.h"
#include "support/tet_cluster.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** A box of irregular tets, some of two other materials, one of them auxetic. */
struct Block
{
  TetMesh mesh = makeBox({3, 2, 2}, {1.5, 1.0, 1.0});
  std::vector<TetStiffnessParameters> parameters;
  Index first_node = 2;

  explicit Block(double least_poisson_ratio = -1.0)
  {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-0.06, 0.06);
    for (Vec3& p : mesh.nodes)
    {
      p += Vec3(uniform(random), uniform(random), uniform(random));
    }
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    {
      const bool other = t % 24 > 11;
      parameters.push_back({other ? 9000.0 : 5000.0, other ? 0.3 : 0.49, 0.7});
    }
    for (std::size_t t = 0; t < 6; ++t)
    {
      parameters[t] = {4000.0, std::max(-0.3, least_poisson_ratio), 0.7};
    }
  }

  void makeUniform(double poisson_ratio)
  {
    parameters.assign(mesh.tets.size(), {5000.0, poisson_ratio, 0.7});
  }

  Points under(const Mat3& f, double shake, unsigned seed) const
  {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-shake, shake);
    Points x(first_node, Vec3::Zero());
    for (const Vec3& p : mesh.nodes)
    {
      x.push_back(f * p + Vec3(0.3, -0.2, 0.5) +
                  Vec3(uniform(random), uniform(random), uniform(random)));
    }
    return x;
  }

  Adjacency neighbours() const
  {
    std::vector<Tet> shifted = mesh.tets;
    for (Tet& tet : shifted)
    {
      for (Index& node : tet)
      {
        node += first_node;
      }
    }
    return nodeNeighbours(static_cast<Index>(mesh.nodes.size()) + first_node, shifted);
  }

  NodalPressureElasticity nodal(MaterialModel model) const
  {
    return NodalPressureElasticity(mesh, model, parameters, first_node);
  }
  TetElasticity plain(MaterialModel model) const
  {
    return TetElasticity(mesh, model, parameters, first_node);
  }
};

class EveryNodalModel : public ::testing::TestWithParam<MaterialModel>
{
 protected:
  Block block_{leastPoissonRatio(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(All, EveryNodalModel, ::testing::ValuesIn(kMaterialModels));

/** Shaken, pulled, squeezed, and with tets inside out. */
std::vector<Points> statesOf(const Block& block)
{
  std::mt19937 random(8);
  return {
      block.under(Mat3::Identity(), 0.02, 1),
      block.under(randomRotation(random) * (Mat3::Identity() + randomMatrix(random, 0.3)), 0.03, 2),
      block.under(stretched(random, 1.2, 0.9, 0.25), 0.05, 3),
      block.under(stretched(random, 1.3, 1.2, 0.4), 0.3, 4)};
}

TEST_P(EveryNodalModel, HasTheEnergyOfNodesAndTetsOneByOne)
{
  NodalPressureElasticity term = block_.nodal(GetParam());
  for (const Points& x : statesOf(block_))
  {
    const double energy =
        nodalPressureEnergy(block_.mesh, GetParam(), block_.parameters, x, block_.first_node);
    EXPECT_NEAR(term.value(x), energy, 1e-12 * energy);
    Points gradient(x.size(), Vec3::Zero());
    EXPECT_NEAR(term.valueAndGradient(x, gradient), energy, 1e-12 * energy);
  }
}

TEST_P(EveryNodalModel, IsThePlainEnergyOfUniformStrain)
{
  std::mt19937 random(9);
  NodalPressureElasticity term = block_.nodal(GetParam());
  TetElasticity plain = block_.plain(GetParam());
  for (int k = 0; k < 5; ++k)
  {
    const Points x = block_.under(
        randomRotation(random) * (Mat3::Identity() + randomMatrix(random, 0.3)), 0.0, 0);
    const double energy = plain.value(x);
    EXPECT_NEAR(term.value(x), energy, 1e-12 * energy);
    const Eigen::VectorXd forces = gradientOf(plain, x);
    EXPECT_LT((gradientOf(term, x) - forces).norm(), 1e-11 * forces.norm());
    std::vector<float> stress, plain_stress;
    term.vonMises(x, stress);
    plain.vonMises(x, plain_stress);
    ASSERT_EQ(stress.size(), plain_stress.size());
    for (std::size_t t = 0; t < stress.size(); ++t)
    {
      EXPECT_NEAR(stress[t], plain_stress[t], 1e-5 * plain_stress[t]);
    }
    EXPECT_NEAR(term.minDetF(x), plain.minDetF(x), 1e-12);
  }
}

// The patch test: nodes inside a uniformly strained body of one material feel no force.
TEST_P(EveryNodalModel, BalancesInsideUniformStrain)
{
  block_.makeUniform(0.4999);
  NodalPressureElasticity term = block_.nodal(GetParam());
  std::mt19937 random(10);
  const Points x = block_.under(Mat3::Identity() + randomMatrix(random, 0.2), 0.0, 0);
  const Eigen::VectorXd forces = gradientOf(term, x);
  const BoundarySurface surface =
      extractBoundary(static_cast<Index>(block_.mesh.nodes.size()), block_.mesh.tets);
  int inside = 0;
  for (std::size_t i = 0; i < block_.mesh.nodes.size(); ++i)
  {
    if (surface.node_slot[i] < 0)
    {
      EXPECT_LT(forces.segment<3>(3 * (block_.first_node + i)).norm(), 1e-11 * forces.norm());
      ++inside;
    }
  }
  EXPECT_EQ(inside, 2);
}

TEST_P(EveryNodalModel, GradientAndHessianAreDerivatives)
{
  NodalPressureElasticity term = block_.nodal(GetParam());
  const Adjacency neighbours = block_.neighbours();
  double worst_gradient = 0.0, worst_hessian = 0.0;
  const std::vector<Points> states = statesOf(block_);
  for (std::size_t k = 0; k < states.size(); ++k)
  {
    if (k == 3 && !isSmooth(GetParam()))
    {
      continue;  // some tets are too near a fold
    }
    const Points& x = states[k];
    const Eigen::VectorXd gradient = gradientOf(term, x);
    const Eigen::MatrixXd hessian = hessianOf(term, x, neighbours, Curvature::exact);
    worst_gradient = std::max(
        worst_gradient, (gradient - differenceGradient(term, x, 1e-4)).norm() / gradient.norm());
    worst_hessian = std::max(worst_hessian,
                             (hessian - differenceHessian(term, x, 1e-4)).norm() / hessian.norm());
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-14 * hessian.norm());
  }
  EXPECT_LT(worst_gradient, 1e-8);
  EXPECT_LT(worst_hessian, 1e-7);
  std::printf("  off their differences by at most %.1e and %.1e\n", worst_gradient, worst_hessian);
}

TEST_P(EveryNodalModel, ProjectedHessianIsPositiveAndNotBelowTheExact)
{
  NodalPressureElasticity term = block_.nodal(GetParam());
  const Adjacency neighbours = block_.neighbours();
  for (const Points& x : statesOf(block_))
  {
    const Eigen::MatrixXd positive = hessianOf(term, x, neighbours);
    const Eigen::MatrixXd exact = hessianOf(term, x, neighbours, Curvature::exact);
    EXPECT_GT(smallestEigenvalue(positive), -1e-12 * positive.norm());
    if (isSmooth(GetParam()))
    {
      EXPECT_GT(smallestEigenvalue(positive - exact), -1e-12 * positive.norm());
    }
  }
}

TEST_P(EveryNodalModel, RotationsAndShiftsMeetNothing)
{
  std::mt19937 random(12);
  NodalPressureElasticity term = block_.nodal(GetParam());
  for (const Points& x : statesOf(block_))
  {
    const double energy = term.value(x);
    Points gradient(x.size(), Vec3::Zero());
    term.addGradient(x, gradient);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      force += gradient[i];
      moment += x[i].cross(gradient[i]);
      size += gradient[i].norm() * (1.0 + x[i].norm());
    }
    EXPECT_LT(force.norm(), 1e-13 * size);
    if (isBlindToRotations(GetParam()))
    {
      const Mat3 turn = randomRotation(random);
      Points turned = x;
      for (Vec3& p : turned)
      {
        p = turn * p;
      }
      EXPECT_NEAR(term.value(turned), energy, 1e-11 * energy);
      EXPECT_LT(moment.norm(), 1e-12 * size);
    }
  }
}

TEST_P(EveryNodalModel, GivesTheSameBitsOnEveryInstructionSetAndThreadCount)
{
  const InstructionSet best = instructionSet();
  Block block(leastPoissonRatio(GetParam()));
  block.mesh = makeBox({8, 8, 8}, {1.0, 1.0, 1.0});  // several pieces for each loop
  block.makeUniform(0.47);
  const Points x = block.under(Mat3::Identity(), 0.03, 6);
  std::vector<Eigen::VectorXd> gradients;
  std::vector<BlockMatrix> matrices;
  for (int set = 0; set <= static_cast<int>(best); ++set)
  {
    for (const int threads : {1, 2})
    {
      setThreadCount(threads);
      forceInstructionSet(static_cast<InstructionSet>(set));
      NodalPressureElasticity term = block.nodal(GetParam());
      Eigen::VectorXd all(3 * x.size() + 1);
      all << gradientOf(term, x), term.value(x);
      gradients.push_back(all);
      matrices.emplace_back(block.neighbours());
      term.addHessian(x, Curvature::positive, matrices.back());
    }
  }
  setThreadCount(1);
  forceInstructionSet(best);
  const OuterProducts& first = matrices[0].outer();
  for (std::size_t k = 0; k < gradients.size(); ++k)
  {
    EXPECT_TRUE(gradients[k] == gradients[0]);
    EXPECT_EQ(matrices[k].values(), matrices[0].values());
    const OuterProducts& outer = matrices[k].outer();
    EXPECT_EQ(outer.weights(), first.weights());
    ASSERT_EQ(outer.nodes(), first.nodes());
    EXPECT_TRUE(
        std::equal(outer.vector(0), outer.vector(0) + 3 * outer.nodes().size(), first.vector(0)));
  }
}

TEST_P(EveryNodalModel, BalancesAgainAfterAHeldStrainHasRelaxed)
{
  ViscosityParameters series;
  series.relaxation = {{0.7, 0.03}, {1.9, 0.4}};
  NodalPressureElasticity law = block_.nodal(GetParam());
  Viscosity memory(law, block_.parameters, series);
  const Points rest = block_.under(Mat3::Identity(), 0.0, 0);
  const Points x = block_.under(Mat3::Identity(), 0.02, 1);
  const Eigen::VectorXd elastic = gradientOf(law, x);
  memory.beginStep(rest, 0.01);
  const Eigen::VectorXd differences = differenceGradient(law, x, 1e-4);
  EXPECT_LT((gradientOf(law, x) - differences).norm(), 1e-8 * differences.norm());
  EXPECT_GT(differences.norm(), 2.0 * elastic.norm());
  const Adjacency neighbours = block_.neighbours();
  const Eigen::MatrixXd hessian = hessianOf(law, x, neighbours, Curvature::exact);
  EXPECT_LT((hessian - differenceHessian(law, x, 1e-4)).norm(), 1e-7 * hessian.norm());
  memory.endStep(x);
  for (int k = 0; k < 400; ++k)
  {
    memory.beginStep(x, 0.02);
    memory.endStep(x);
  }
  memory.beginStep(x, 0.02);
  const Eigen::VectorXd both = gradientOf(law, x) + gradientOf(memory, x);
  if (isBlindToRotations(GetParam()))  // the others relax in small strains only
  {
    EXPECT_LT((both - elastic).norm(), 1e-6 * elastic.norm());
  }
}

// Volume is up to the nodes, so it has no damping of its own.
TEST_P(EveryNodalModel, DampsShearOnly)
{
  ViscosityParameters damping;
  damping.stiffness_damping = 0.1;
  block_.makeUniform(0.49);
  NodalPressureElasticity law = block_.nodal(GetParam());
  Viscosity memory(law, block_.parameters, damping);
  Block without = block_;
  without.parameters.assign(block_.mesh.tets.size(), {2.0 * lameFrom(5000.0, 0.49).mu, 0.0, 0.7});
  TetElasticity plain = without.plain(GetParam());
  Viscosity plain_memory(plain, without.parameters, damping);
  const Points x = block_.under(Mat3::Identity(), 0.02, 1);
  memory.beginStep(block_.under(Mat3::Identity(), 0.0, 0), 0.01);
  plain_memory.beginStep(block_.under(Mat3::Identity(), 0.0, 0), 0.01);
  const Eigen::VectorXd forces = gradientOf(plain_memory, x);
  EXPECT_LT((gradientOf(memory, x) - forces).norm(), 1e-12 * forces.norm());
}

TEST(NodalPressureElasticity, AuxeticTetsKeepTheirVolumeThemselves)
{
  Block block;
  block.makeUniform(-0.3);
  const Points x = block.under(Mat3::Identity(), 0.05, 1);
  NodalPressureElasticity term = block.nodal(MaterialModel::neo_hookean);
  TetElasticity plain = block.plain(MaterialModel::neo_hookean);
  EXPECT_EQ(term.value(x), plain.value(x));
  EXPECT_TRUE(gradientOf(term, x) == gradientOf(plain, x));
  BlockMatrix hessian(block.neighbours());
  term.addHessian(x, Curvature::exact, hessian);
  EXPECT_TRUE(hessian.outer().empty());
}

TEST(NodalPressureElasticity, RefusesATetWithoutVolume)
{
  TetMesh flat = unitTet();
  flat.nodes[3] = Vec3(0.5, 0.5, 0.0);
  try
  {
    NodalPressureElasticity term(flat, MaterialModel::corotated, {{5000.0, 0.3}}, 0);
    FAIL() << "accepted";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("tet 0 has rest volume"), std::string::npos);
  }
}

}  // namespace
}  // namespace soft_tissue
