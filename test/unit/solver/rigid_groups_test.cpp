#include "soft_tissue_sim/solver/rigid_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/solver/linear_solver.h"
#include "support/block_matrices.h"
#include "support/finite_difference.h"

namespace soft_tissue
{
namespace
{
using namespace test;

/** A bar held at one end, on some ground to keep it from being singular; its other half may be
 * stiffer. */
struct Bar
{
  static constexpr double kMiddle = 1.5;
  TetMesh mesh = makeBox({3, 3, 30}, {0.3, 0.3, 3.0});
  BlockMatrix matrix = BlockMatrix(nodeNeighbours(Index(mesh.nodes.size()), mesh.tets));
  std::vector<Index> fixed;

  explicit Bar(double stiffer = 1.0)
  {
    std::vector<TetStiffnessParameters> stiffness(mesh.tets.size(), {1000.0, 0.4});
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    {
      double sum = 0.0;
      for (const Index node : mesh.tets[t])
      {
        sum += mesh.nodes[node].z();
      }
      stiffness[t].young_modulus *= sum > 4.0 * kMiddle ? stiffer : 1.0;
    }
    TetElasticity elasticity(mesh, MaterialModel::corotated, stiffness, 0);
    elasticity.addHessian(mesh.nodes, Curvature::positive, matrix);
    for (Index i = 0; i < matrix.rows(); ++i)
    {
      addDiagonal(matrix, i, 1e-3);
      if (mesh.nodes[i].z() < 1e-9)
      {
        fixed.push_back(i);
      }
    }
    for (Index row = 0; row < matrix.rows(); ++row)
    {
      for (Index k = matrix.offsets()[row]; k < matrix.offsets()[row + 1]; ++k)
      {
        const Index column = matrix.columns()[k];
        if (isFixed(row) || isFixed(column))
        {
          Eigen::Map<Mat3>(matrix.block(k)) = (row == column ? 1.0 : 0.0) * Mat3::Identity();
        }
      }
    }
  }

  bool isFixed(Index node) const
  {
    return std::find(fixed.begin(), fixed.end(), node) != fixed.end();
  }

  /** A weight at the far end. */
  Points load() const
  {
    Points b(mesh.nodes.size(), Vec3::Zero());
    for (std::size_t i = 0; i < b.size(); ++i)
    {
      if (mesh.nodes[i].z() > 3.0 - 1e-9)
      {
        b[i] = Vec3(1.0, 0.5, 0.0);
      }
    }
    return b;
  }
};

TEST(Pcg, RigidGroupsShortenASlendersBodysWayToBalance)
{
  const Bar bar;
  const Points b = bar.load();
  Points d;
  // Equal places leave no groups but points: neighbours alone have to agree.
  const int alone =
      solveWith(*makePcg(), bar.matrix, b, Points(b.size(), Vec3::Zero()), 1e-8, d).iterations;
  const int grouped = solveWith(*makePcg(), bar.matrix, b, bar.mesh.nodes, 1e-8, d).iterations;
  std::printf("  %d iterations, without rotations of groups %d\n", grouped, alone);
  EXPECT_LT(3 * grouped, 2 * alone);
  EXPECT_LT((flat(b) - dense(bar.matrix) * flat(d)).norm(), 1.01e-8 * flat(b).norm());
}

TEST(Pcg, RigidGroupsLeaveFixedNodesWhereTheyAre)
{
  const Bar bar;
  for (const double tolerance : {1e-2, 1e-8})  // single and double precision
  {
    Points d;
    solveWith(*makePcg(), bar.matrix, bar.load(), bar.mesh.nodes, tolerance, d);
    for (const Index node : bar.fixed)
    {
      EXPECT_EQ(d[node], Vec3::Zero());
    }
  }
}

TEST(Pcg, RigidGroupsMoveAStiffPartOnASoftOne)
{
  const Bar even;
  const Points b = even.load();
  for (const double tolerance : {1e-2, 1e-8})
  {
    Points d;
    const int alike =
        solveWith(*makePcg(), even.matrix, b, even.mesh.nodes, tolerance, d).iterations;
    for (const double stiffer : {1e3, 1e6})
    {
      const Bar bar(stiffer);
      const LinearReport report =
          solveWith(*makePcg(), bar.matrix, b, bar.mesh.nodes, tolerance, d);
      std::printf("  %g times stiffer, to %g: %d iterations, alike %d\n", stiffer, tolerance,
                  report.iterations, alike);
      EXPECT_LE(report.iterations, 2 * alike);
      const Eigen::MatrixXd matrix = dense(bar.matrix);
      const double rounding = 1e-16 * matrix.norm() * flat(d).norm();
      EXPECT_LT((flat(b) - matrix * flat(d)).norm(), 1.01 * tolerance * flat(b).norm() + rounding);
      const Eigen::VectorXd exact = matrix.ldlt().solve(flat(b));
      EXPECT_LT((flat(d) - exact).norm(), (tolerance < 1e-3 ? 1e-4 : 0.1) * exact.norm());
    }
  }
}

TEST(RigidGroups, AreOfStiffNodesOrOfSoftOnes)
{
  const Bar even, bar(1e6);
  RigidGroups alike, groups;
  alike.build(even.matrix, even.mesh.nodes);
  groups.build(bar.matrix, bar.mesh.nodes);
  EXPECT_LT(alike.contrast(), 100.0);
  EXPECT_GT(groups.contrast(), 1e5);
  EXPECT_LT(groups.contrast(), 1e8);
  const auto isStiff = [&](Index node) { return bar.mesh.nodes[node].z() > Bar::kMiddle - 1e-9; };
  for (int g = 0; g < groups.size(); ++g)
  {
    for (Index i = groups.offsets()[g]; i < groups.offsets()[g + 1]; ++i)
    {
      EXPECT_EQ(isStiff(groups.nodes()[i]), isStiff(groups.nodes()[groups.offsets()[g]])) << g;
    }
  }
  // Rigid motions of what is stiff have to be exact: a small turn makes others of them.
  Points x = bar.mesh.nodes;
  for (Vec3& p : x)
  {
    p.x() += 0.01 * p.z();
  }
  EXPECT_FALSE(alike.outdated(even.matrix, x));
  EXPECT_TRUE(groups.outdated(bar.matrix, x));
}

TEST(RigidGroups, CoarseMatrixIsThatOfRigidMotions)
{
  const Bar bar;
  RigidGroups groups;
  EXPECT_TRUE(groups.outdated(bar.matrix, bar.mesh.nodes));
  groups.build(bar.matrix, bar.mesh.nodes);
  EXPECT_FALSE(groups.outdated(bar.matrix, bar.mesh.nodes));
  ASSERT_GE(groups.size(), 2);
  const Eigen::Index n = 3 * bar.matrix.rows(), coarse = 6 * groups.size();
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(n, coarse);
  std::vector<int> members(bar.matrix.rows(), 0);
  for (int g = 0; g < groups.size(); ++g)
  {
    for (Index i = groups.offsets()[g]; i < groups.offsets()[g + 1]; ++i)
    {
      const Index node = groups.nodes()[i];
      ++members[node];
      EXPECT_EQ(groups.group()[node], g);
      const Vec3 arm = Eigen::Map<const Vec3>(groups.arms().data() + 3 * node);
      for (int axis = 0; axis < 3; ++axis)
      {
        motions.block<3, 1>(3 * node, 6 * g + axis) = Vec3::Unit(axis);
        motions.block<3, 1>(3 * node, 6 * g + 3 + axis) = Vec3::Unit(axis).cross(arm);
      }
    }
  }
  for (Index node = 0; node < bar.matrix.rows(); ++node)
  {
    EXPECT_EQ(members[node], bar.isFixed(node) ? 0 : 1) << node;
    EXPECT_EQ(groups.group()[node] == groups.size(), bar.isFixed(node)) << node;
  }
  Eigen::MatrixXd expected = motions.transpose() * dense(bar.matrix) * motions;
  expected.diagonal().array() += 1e-6 * expected.diagonal().maxCoeff();
  const Eigen::MatrixXd inverse =
      Eigen::Map<const Eigen::MatrixXd>(groups.inverse().data(), coarse, coarse);
  EXPECT_LT((inverse * expected - Eigen::MatrixXd::Identity(coarse, coarse)).norm(), 1e-8);
}

/** Two bodies whose boxes overlap, with something between them. */
TEST(RigidGroups, BelongToOneBodyEachAndSeeWhatCouplesThem)
{
  const Index each = 200;
  TetMesh pair = makeBox({4, 4, 7}, {0.4, 0.4, 0.7});
  ASSERT_EQ(pair.nodes.size(), std::size_t(each));
  const std::size_t tets = pair.tets.size();
  for (Index i = 0; i < each; ++i)
  {
    pair.nodes.push_back(pair.nodes[i] + Vec3(0.05, 0.05, 0.05));
  }
  for (std::size_t t = 0; t < tets; ++t)
  {
    Tet other = pair.tets[t];
    for (Index& node : other)
    {
      node += each;
    }
    pair.tets.push_back(other);
  }
  BlockMatrix matrix(nodeNeighbours(2 * each, pair.tets));
  addRandomElements(pair.tets, 71, matrix);
  RigidGroups apart, coupled;
  apart.build(matrix, pair.nodes);
  matrix.add(3, each + 5, 0.5 * Mat3::Identity());
  coupled.build(matrix, pair.nodes);
  ASSERT_GE(coupled.size(), 4);
  for (int g = 0; g < coupled.size(); ++g)
  {
    const Index first = coupled.nodes()[coupled.offsets()[g]];
    const Index last = coupled.nodes()[coupled.offsets()[g + 1] - 1];
    EXPECT_EQ(first < each, last < each) << g;
  }
  EXPECT_NE(apart.inverse(), coupled.inverse());
  EXPECT_TRUE(apart.outdated(matrix, pair.nodes)) << "something came to couple them";
  EXPECT_FALSE(coupled.outdated(matrix, pair.nodes));
}

TEST(RigidGroups, PutAllNodesInAnOrder)
{
  const Bar bar;
  RigidGroups groups;
  groups.build(bar.matrix, bar.mesh.nodes);
  ASSERT_GT(groups.size(), 1);
  std::vector<Index> nodes = groups.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    const auto after =
        std::upper_bound(groups.offsets().begin(), groups.offsets().end(), static_cast<Index>(i));
    EXPECT_EQ(groups.group()[nodes[i]], after - groups.offsets().begin() - 1);
  }
  std::sort(nodes.begin(), nodes.end());
  ASSERT_EQ(nodes.size(), bar.mesh.nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
  {
    EXPECT_EQ(nodes[i], static_cast<Index>(i));
  }
}

TEST(RigidGroups, AreOutdatedByWhatIsFarFromWhereTheyWereBuilt)
{
  const Bar bar;
  RigidGroups groups;
  groups.build(bar.matrix, bar.mesh.nodes);
  Points x = bar.mesh.nodes;
  const Index last = groups.nodes()[groups.offsets().back() - 1];
  x[last].x() += 0.01;
  EXPECT_FALSE(groups.outdated(bar.matrix, x));
  x[last].x() += 1.0;
  EXPECT_TRUE(groups.outdated(bar.matrix, x));
  groups.build(bar.matrix, x);
  EXPECT_FALSE(groups.outdated(bar.matrix, x));
}

// Neither A nor its rigid motions change with a body that flies; they do with one that turns.
TEST(RigidGroups, LastWhileTheirBodyFliesButNotWhileItTurns)
{
  const Bar bar;
  RigidGroups groups;
  groups.build(bar.matrix, bar.mesh.nodes);
  const auto outdatedAt = [&](const Eigen::Isometry3d& pose) {
    Points x = bar.mesh.nodes;
    for (Vec3& p : x)
    {
      p = pose * p;
    }
    return groups.outdated(bar.matrix, x);
  };
  const auto turned = [](double angle) {
    return Eigen::Isometry3d(Eigen::AngleAxisd(angle, Vec3(1.0, 2.0, -2.0) / 3.0));
  };
  EXPECT_FALSE(outdatedAt(Eigen::Isometry3d(Eigen::Translation3d(3.0, -2.0, 5.0))));
  EXPECT_FALSE(outdatedAt(Eigen::Translation3d(1.0, 1.0, 1.0) * turned(0.1)));
  EXPECT_TRUE(outdatedAt(turned(0.5)));
}

}  // namespace
}  // namespace soft_tissue
