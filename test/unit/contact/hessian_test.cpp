#include <gtest/gtest.h>

#include <cstdio>

#include "support/contact_derivatives.h"
#include "support/contact_scene.h"

namespace soft_tissue::test
{
namespace
{
const Vec3 kTool(0.0102, 0.0097, 0.0155);

TetMesh tissue()
{
  return slab(Vec3::Zero(), {0.021, 0.021, 0.014}, 3, 3, 2);
}

/** Two tools: a ball that bends everything, and a box whose edges and faces meet flat triangles. */
std::vector<std::shared_ptr<const RigidShape>> tools()
{
  return {makeSphere(0.006), makeBox({0.008, 0.009, 0.007})};
}
}  // namespace

TEST(ContactHessian, IsTheSecondDerivative)
{
  for (const auto& tool : tools())
  {
    for (const ContactOptions& options : contactModels(1e6))
    {
      ContactScene scene(tissue(), tool, options);
      const Points start = shaken(scene.mesh.nodes, 0.0005, 41);
      scene.begin(start, at(kTool));
      const Points x = shaken(start, 0.0002, 42);
      const Eigen::MatrixXd difference = centralDifference(*scene.contact, x);
      const Eigen::MatrixXd exact =
          hessianOf(*scene.contact, x, scene.node_neighbours, Curvature::exact);
      const Eigen::MatrixXd linear =
          hessianOf(*scene.contact, x, scene.node_neighbours, Curvature::positive);
      ASSERT_GT(exact.norm(), 0.0);
      const double error = (difference - exact).norm() / difference.norm();
      const double left_out = (difference - linear).norm() / difference.norm();
      std::printf("  %s: off its difference by %.1e; without the curvature of depth by %.1e\n",
                  nameOf(options).c_str(), error, left_out);
      // Left out: what the motion of clip points adds, and that of the kinks of an interpolated
      // depth along an edge.
      const double most = options.closest_feature ? 0.15 : 0.6;
      EXPECT_LT(error, options.segments ? most * left_out : 1e-7) << nameOf(options);
    }
  }
}

TEST(ContactHessian, PositivePartIsTheSumOfItsSamplesAndSemiDefinite)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    ContactScene scene(tissue(), makeSphere(0.006), options);
    const Points x = shaken(scene.mesh.nodes, 0.0006, 43);
    scene.begin(x, at(kTool));
    const Eigen::MatrixXd hessian =
        hessianOf(*scene.contact, x, scene.node_neighbours, Curvature::positive);
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

}  // namespace soft_tissue::test
