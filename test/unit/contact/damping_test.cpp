#include <gtest/gtest.h>

#include <cstdio>

#include "support/contact_derivatives.h"
#include "support/contact_scene.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kStep = 0.01, kDamping = 3.0, kSpeed = 0.02;
const Vec3 kTool(0.0102, 0.0097, 0.0165);

/** A ball in a slab that goes on at a velocity for a step, with damping and without. */
struct Approach
{
  ContactScene with, without;
  Points start;

  Approach(ContactOptions options, const Vec3& velocity)
      : with(tissue(), makeSphere(0.006), damped(options)),
        without(tissue(), makeSphere(0.006), options),
        start(shaken(with.mesh.nodes, 0.0004, 51))
  {
    for (ContactScene* scene : {&with, &without})
    {
      scene->contact->setStep(kStep);
      scene->contact->beginStep(start, at(kTool), at(kTool + kStep * velocity), true);
    }
  }

  static TetMesh tissue() { return slab(Vec3::Zero(), {0.021, 0.021, 0.014}, 3, 3, 2); }
  static ContactOptions damped(ContactOptions options)
  {
    options.damping_s_per_m = kDamping;
    return options;
  }
};

// The ball comes down on tissue that stays: each contact feels its share of its own pressure.
TEST(ContactDamping, IsAShareOfThePressureByTheSpeedOfApproach)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    Approach down(options, Vec3(0.0, 0.0, -kSpeed));
    ContactScene before(Approach::tissue(), makeSphere(0.006), options);
    before.begin(down.start, at(kTool));
    double expected = 0.0, found = 0.0;
    for (const ContactSample& s : before.contact->samples(down.start))
    {
      if (s.stiffness_area > 0.0)
      {
        expected += kDamping * s.force * std::max(0.0, kSpeed * s.normal().z());
      }
    }
    for (const FrictionForce& f : down.with.contact->frictionForces(down.start))
    {
      EXPECT_LT(f.on_first.cross(f.normal).norm(), 1e-12);
      EXPECT_GE(f.on_first.dot(f.normal), 0.0) << "the tissue never pulls the tool";
      found += f.on_first.norm();
    }
    ASSERT_GT(expected, 0.0);
    EXPECT_NEAR(found, expected, 1e-6 * expected) << nameOf(options);
  }
}

TEST(ContactDamping, DoesNotHoldBackWhatParts)
{
  Approach up(contactModels(1e6)[3], Vec3(0.0, 0.0, kSpeed));
  for (const FrictionForce& f : up.with.contact->frictionForces(up.start))
  {
    EXPECT_LT(f.on_first.norm(), 1e-4 * 1e6 * 1e-6);  // sideways some still come nearer
  }
  EXPECT_LT(up.with.contact->value(up.start) - up.without.contact->value(up.start), 1e-9);
}

TEST(ContactDamping, HasItsForceForGradientAndAHessian)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    Approach down(options, Vec3(0.0, 0.0, -kSpeed));
    RandomGeometry random(3);
    const Points x = shaken(down.start, 2e-5, 52);
    const Eigen::VectorXd force =
        gradientOf(*down.with.contact, x) - gradientOf(*down.without.contact, x);
    ASSERT_GT(force.norm(), 0.0);
    EXPECT_LT(gradientError(*down.with.contact, x, random), 1e-6);
    const Adjacency& rows = down.with.node_neighbours;
    const Eigen::MatrixXd added = hessianOf(*down.with.contact, x, rows, Curvature::exact) -
                                  hessianOf(*down.without.contact, x, rows, Curvature::exact);
    const Eigen::MatrixXd expected =
        centralDifference(*down.with.contact, x) - centralDifference(*down.without.contact, x);
    std::printf("  %s: Hessian off by %.1e\n", nameOf(options).c_str(),
                (added - expected).norm() / added.norm());
    EXPECT_LT((added - expected).norm(), 1e-3 * added.norm()) << nameOf(options);
  }
}

TEST(ContactDamping, TakesNothingWhereThereIsNoTime)
{
  Approach down(contactModels(1e6)[3], Vec3(0.0, 0.0, -kSpeed));
  down.with.contact->setStep(std::numeric_limits<double>::infinity());
  down.with.contact->beginStep(down.start, at(kTool), at(kTool - Vec3(0.0, 0.0, 1e-4)), true);
  down.without.contact->beginStep(down.start, at(kTool), at(kTool - Vec3(0.0, 0.0, 1e-4)), true);
  EXPECT_EQ(down.with.contact->value(down.start), down.without.contact->value(down.start));
}

}  // namespace
}  // namespace soft_tissue::test
