#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/base/error.h"
#include "support/contact_oracle.h"
#include "support/contact_scene.h"
#include "support/finite_difference.h"

namespace soft_tissue::test
{
namespace
{
const Vec3 kTool(0.0102, 0.0097, 0.0155);

TetMesh tissue()
{
  return slab(Vec3::Zero(), {0.021, 0.021, 0.014}, 3, 3, 2);
}

Eigen::MatrixXd centralDifference(ToolContact& contact, const Points& x)
{
  constexpr double kStep = 1e-8;
  Eigen::MatrixXd hessian(3 * x.size(), 3 * x.size());
  for (Eigen::Index k = 0; k < hessian.cols(); ++k)
  {
    Points moved = x;
    moved[k / 3][k % 3] += kStep;
    hessian.col(k) = gradientOf(contact, moved);
    moved[k / 3][k % 3] -= 2.0 * kStep;
    hessian.col(k) -= gradientOf(contact, moved);
  }
  return hessian / (2.0 * kStep);
}

/** Everything the Gauss-Newton Hessian leaves out for points and interpolated depth, 3N x 3N. */
Eigen::MatrixXd leftOut(ContactScene& scene, const Points& x)
{
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * x.size(), 3 * x.size());
  for (const ContactSample& s : scene.contact->samples(x))
  {
    if (s.tool_sign < 0)
    {
      sum.block<3, 3>(3 * s.node[0], 3 * s.node[0]) += s.force * ballCurvature(s.position, kTool);
      continue;
    }
    std::array<Vec3, 4> corners;
    Eigen::Vector4d depth;
    for (int k = 0; k < 4; ++k)
    {
      corners[k] = x[s.node[k]];
      depth[k] = scene.contact->depth()[s.node[k]];
    }
    const Eigen::MatrixXd curvature = interpolatedCurvature(corners, s.position, depth);
    for (int i = 0; i < 4; ++i)
    {
      for (int j = 0; j < 4; ++j)
      {
        sum.block<3, 3>(3 * s.node[i], 3 * s.node[j]) +=
            s.force * curvature.block<3, 3>(3 * i, 3 * j);
      }
    }
  }
  return sum;
}
}  // namespace

TEST(ContactHessian, IsTheSecondDerivativeLessTheCurvatureOfDepth)
{
  ToolContactOptions options = contactModels(1e6)[0];  // points, interpolated
  ContactScene scene(tissue(), makeSphere(0.006), options);
  const Points start = shaken(scene.mesh.nodes, 0.0005, 41);
  scene.begin(start, at(kTool));
  const Points x = shaken(start, 0.0002, 42);
  const Eigen::MatrixXd difference = centralDifference(*scene.contact, x);
  const Eigen::MatrixXd hessian = hessianOf(*scene.contact, x, scene.node_neighbours);
  const Eigen::MatrixXd rest = leftOut(scene, x);
  ASSERT_GT(rest.norm(), 1e-3 * hessian.norm());
  const double error = (difference - rest - hessian).norm() / hessian.norm();
  std::printf("  off its difference by %.1e, of which %.1e is curvature of depth\n",
              (difference - hessian).norm() / hessian.norm(), rest.norm() / hessian.norm());
  std::printf("  off its difference less that by %.1e\n", error);
  EXPECT_LT(error, 1e-6);
}

TEST(ContactHessian, IsTheSumOfItsSamplesAndPositiveSemiDefinite)
{
  for (const ToolContactOptions& options : contactModels(1e6))
  {
    ContactScene scene(tissue(), makeSphere(0.006), options);
    const Points x = shaken(scene.mesh.nodes, 0.0006, 43);
    scene.begin(x, at(kTool));
    const Eigen::MatrixXd hessian = hessianOf(*scene.contact, x, scene.node_neighbours);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(hessian.rows(), hessian.cols());
    for (const ContactSample& s : scene.contact->samples(x))
    {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(hessian.cols());
      for (int k = 0; k < s.count; ++k)
      {
        row.segment<3>(3 * s.node[k]) += s.coefficient[k] * s.gradient;
      }
      sum += s.stiffness_area * row * row.transpose();
    }
    ASSERT_GT(sum.norm(), 0.0);
    EXPECT_LT((hessian - sum).norm(), 1e-12 * sum.norm()) << nameOf(options);
    EXPECT_GT(smallestEigenvalue(hessian), -1e-12 * sum.norm()) << nameOf(options);
  }
}

TEST(ContactHessian, RejectsAMatrixWithoutItsCouplings)
{
  ContactScene scene(tissue(), makeSphere(0.006), contactModels(1e6)[0]);
  scene.begin(scene.mesh.nodes, at(kTool));
  Adjacency lonely;
  lonely.offsets.assign(scene.mesh.nodes.size() + 1, 0);
  BlockMatrix diagonal(lonely);
  EXPECT_THROW(scene.contact->addHessian(scene.mesh.nodes, Curvature::positive, diagonal), Error);
}

}  // namespace soft_tissue::test
