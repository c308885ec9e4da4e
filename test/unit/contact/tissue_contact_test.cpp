#include "soft_tissue_sim/contact/tissue_contact.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/geometry/barycentric.h"
#include "support/contact_derivatives.h"
#include "support/tissue_pair.h"

namespace soft_tissue::test
{
namespace
{

/** Two blocks of different meshes, the second on top of the first and a millimetre in it. */
TissuePair blocks(const ContactOptions& options, double deep = 0.001)
{
  return TissuePair(slab(Vec3::Zero(), {0.024, 0.024, 0.012}, 3, 3, 2),
                    slab({0.005, 0.004, 0.012 - deep}, {0.02, 0.021, 0.022}, 2, 4, 2), options);
}

constexpr double kLength = 0.1, kHeight = 0.006;

TetMesh bar()
{
  return slab(Vec3::Zero(), {kLength, 0.008, kHeight}, 24, 2, 2);
}

ContactOptions rubbing(ContactOptions options)
{
  options.friction = 0.4;
  return options;
}
}  // namespace

TEST(TissueContact, GradientIsTheDerivativeOfTheValue)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    double worst = 0.0;
    for (unsigned seed = 0; seed < 4; ++seed)
    {
      RandomGeometry random(seed);
      TissuePair pair = blocks(options);
      const Points start = shaken(pair.x, 0.0004, seed + 10);
      pair.contact->beginStep(start, start, true);
      const Points x = shaken(start, 0.0002, seed + 20);
      EXPECT_GT(pair.contact->samples(x).size(), 5u);
      worst = std::max(worst, gradientError(*pair.contact, x, random));
    }
    std::printf("  %s: off its difference by at most %.1e\n", nameOf(options).c_str(), worst);
    EXPECT_LT(worst, 1e-6) << nameOf(options);
  }
}

TEST(TissueContact, HessianIsTheSecondDerivative)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    TissuePair pair = blocks(options);
    const Points start = shaken(pair.x, 0.0004, 41);
    pair.contact->beginStep(start, start, true);
    const Points x = shaken(start, 0.0002, 42);
    const Eigen::MatrixXd difference = centralDifference(*pair.contact, x);
    const Eigen::MatrixXd exact = hessianOf(*pair.contact, x, pair.neighbours, Curvature::exact);
    const Eigen::MatrixXd linear =
        hessianOf(*pair.contact, x, pair.neighbours, Curvature::positive);
    const double error = (difference - exact).norm() / difference.norm();
    const double left_out = (difference - linear).norm() / difference.norm();
    std::printf("  %s: off its difference by %.1e; without the curvature of depth by %.1e\n",
                nameOf(options).c_str(), error, left_out);
    // Left out: what the motion of clip points adds, which is much on so few long edges.
    const double most = options.closest_feature ? 0.4 : 0.6;
    EXPECT_LT(error, options.segments ? most * left_out : 1e-6) << nameOf(options);
    EXPECT_GT(smallestEigenvalue(linear), -1e-12 * linear.norm()) << nameOf(options);
  }
}

// Where only a part of the depth presses. Pieces of edges with interpolated depth end at tets,
// where what is left of it is not zero: their gradient is off by what the rule is.
TEST(TissueContact, DerivativesAreThoseOfTheDepthThatIsNotAllowed)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    TissuePair pair = blocks(options);
    const Points start = shaken(pair.x, 0.0004, 41);
    pair.contact->setAllowance(0.0003);
    pair.contact->beginStep(start, start, true);
    const Points x = shaken(start, 0.0002, 42);
    for (const ContactSample& sample : pair.contact->samples(x))
    {
      if (sample.stiffness_area > 0.0)
      {
        EXPECT_NEAR(sample.force, sample.stiffness_area * (sample.depth - 0.0003), 1e-15);
        EXPECT_GT(sample.depth, 0.0003);
      }
    }
    RandomGeometry random(43);
    const double off = gradientError(*pair.contact, x, random);
    std::printf("  %s: off its difference by at most %.1e\n", nameOf(options).c_str(), off);
    EXPECT_LT(off, options.segments && !options.closest_feature ? 0.05 : 1e-6) << nameOf(options);
    if (!options.segments)
    {
      const Eigen::MatrixXd difference = centralDifference(*pair.contact, x);
      const Eigen::MatrixXd exact = hessianOf(*pair.contact, x, pair.neighbours, Curvature::exact);
      EXPECT_LT((difference - exact).norm(), 1e-6 * difference.norm()) << nameOf(options);
    }
  }
}

TEST(TissueContact, ForcesAndMomentsOfBothBodiesSumToZero)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    TissuePair pair = blocks(options);
    const Points x = shaken(pair.x, 0.0005, 51);
    pair.contact->beginStep(x, x, true);
    const NodalSums sums(*pair.contact, x);
    ASSERT_GT(sums.force_size, 0.0);
    EXPECT_LT(sums.force.norm(), 1e-12 * sums.force_size) << nameOf(options);
    EXPECT_LT(sums.moment.norm(), 1e-12 * sums.moment_size) << nameOf(options);
    Vec3 on_first = Vec3::Zero();
    for (const ContactSample& s : pair.contact->samples(x))
    {
      on_first += s.forceOnFirst();
    }
    EXPECT_LT(on_first.z(), 0.0) << "the first lies below";
    EXPECT_LT(Vec3(on_first.x(), on_first.y(), 0.0).norm(), 0.5 * on_first.norm());
  }
}

TEST(TissueContact, FrictionHoldsBackWithoutTurning)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    TissuePair pair = blocks(rubbing(options));
    TissuePair smooth = blocks(options);
    const Points start = shaken(pair.x, 0.0004, 61);
    pair.contact->beginStep(start, start, true);
    smooth.contact->beginStep(start, start, true);
    Points x = start;
    const Vec3 slid(4e-7, -3e-7, 0.0);
    for (Index i = pair.second.first_node; i < Index(x.size()); ++i)
    {
      x[i] += slid;
    }
    RandomGeometry random(62);
    EXPECT_LT(gradientError(*pair.contact, x, random), 1e-6) << nameOf(options);
    Vec3 on_first = Vec3::Zero();
    for (const FrictionForce& f : pair.contact->frictionForces(x))
    {
      EXPECT_GT(f.on_first.dot(slid), 0.0) << "taken along by the second";
      EXPECT_NEAR(f.on_first.dot(f.normal), 0.0, 1e-12);
      on_first += f.on_first;
    }
    EXPECT_GT(on_first.dot(slid), 0.0);
    const NodalSums with(*pair.contact, x), without(*smooth.contact, x);
    const double size = on_first.norm();
    EXPECT_LT((with.force - without.force).norm(), 1e-11 * size) << nameOf(options);
    // What slid is all the lever it has.
    EXPECT_LT((with.moment - without.moment).norm(), 2.0 * slid.norm() * size) << nameOf(options);
    EXPECT_TRUE(smooth.contact->frictionForces(x).empty());
  }
}

TEST(TissueContact, KnowsBodiesAgainThatWereApartInTheCourseOfAStep)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    TissuePair pair = blocks(options);
    pair.contact->beginStep(pair.x, pair.x, true);
    const double energy = pair.contact->value(pair.x);
    ASSERT_GT(energy, 0.0);
    Points apart = pair.x;
    for (Index i = pair.second.first_node; i < Index(apart.size()); ++i)
    {
      apart[i].z() += 0.1;
    }
    EXPECT_EQ(pair.contact->value(apart), 0.0);
    EXPECT_EQ(pair.contact->value(pair.x), energy) << nameOf(options);
  }
}

TEST(TissueContact, SeesNothingWhereBodiesAreApart)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    TissuePair pair = blocks(options, -0.1);
    pair.contact->beginStep(pair.x, pair.x, true);
    EXPECT_FALSE(pair.contact->active());
    EXPECT_EQ(pair.contact->value(pair.x), 0.0);
    TissuePair near = blocks(options, -1e-6);
    near.contact->beginStep(near.x, near.x, true);
    EXPECT_TRUE(near.contact->active());
    EXPECT_TRUE(near.contact->samples(near.x).empty());
  }
}

TEST(TissueContact, IsTheSameEnergyHoweverFarBodiesMoveInAStep)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    TissuePair near = blocks(options);
    TissuePair far = blocks(options);
    near.contact->beginStep(near.x, near.x, true);
    Points apart = near.x;
    for (Index i = far.second.first_node; i < Index(apart.size()); ++i)
    {
      apart[i].z() += 0.0027;  // near enough to be watched
    }
    far.contact->beginStep(apart, apart, true);
    EXPECT_TRUE(far.contact->samples(apart).empty());
    const double expected = near.contact->value(near.x);
    ASSERT_GT(expected, 0.0);
    EXPECT_NEAR(far.contact->value(near.x), expected, 1e-9 * expected) << nameOf(options);
    Points lost = near.x;
    lost[3].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NO_THROW(near.contact->value(lost)) << nameOf(options);
  }
}

// Two roof-like wedges whose ridges cross: no node of one is in the other.
TEST(TissueContact, SegmentsSeparateEdgesThatPointsDoNotSee)
{
  TetMesh below, above;
  below.nodes = {{-0.01, 0, 0}, {0.01, 0, 0}, {0, -0.01, -0.01}, {0, 0.01, -0.01}};
  above.nodes = {{0, -0.01, -0.001}, {0, 0.01, -0.001}, {-0.01, 0, 0.009}, {0.01, 0, 0.009}};
  below.tets = above.tets = {{0, 1, 2, 3}};
  for (TetMesh* mesh : {&below, &above})
  {
    const auto& n = mesh->nodes;
    if (signedVolume6(n[0], n[1], n[2], n[3]) < 0.0)
    {
      std::swap(mesh->tets[0][2], mesh->tets[0][3]);
    }
    mesh->tags = {0};
  }
  for (const ContactOptions& options : contactModels(1e6))
  {
    if (!options.closest_feature)
    {
      continue;  // a tet of boundary nodes alone has no depth to interpolate
    }
    TissuePair pair(below, above, options);
    pair.contact->beginStep(pair.x, pair.x, true);
    const NodalSums sums(*pair.contact, pair.x);
    if (!options.segments)
    {
      EXPECT_EQ(sums.force_size, 0.0);
      continue;
    }
    ASSERT_GT(sums.force_size, 0.0);
    Vec3 on_first = Vec3::Zero();
    for (const ContactSample& s : pair.contact->samples(pair.x))
    {
      on_first += s.forceOnFirst();
    }
    EXPECT_LT(on_first.z(), 0.0) << "pushed apart";
    EXPECT_LT(std::hypot(on_first.x(), on_first.y()), 1e-9 * on_first.norm()) << "straight";
  }
}

TEST(SelfContact, IsNoneAtRestNorInABodyThatIsOnlyBent)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    SelfContact self(bar(), options);
    self.contact->beginStep(self.body.mesh.nodes, self.body.mesh.nodes, true);
    EXPECT_EQ(self.contact->value(self.body.mesh.nodes), 0.0) << nameOf(options);
    const Points rolled = rolledUp(self.body.mesh.nodes, kLength, 1.3 * kHeight);
    self.contact->beginStep(rolled, rolled, true);
    EXPECT_EQ(self.contact->value(rolled), 0.0) << nameOf(options);
  }
}

TEST(SelfContact, PushesWhatWentThroughItselfOutAgain)
{
  const double pitch = 0.8 * kHeight;
  for (const ContactOptions& options : contactModels(1e6))
  {
    SelfContact self(bar(), options);
    const Points x = shaken(rolledUp(self.body.mesh.nodes, kLength, pitch), 2e-4, 72);
    self.contact->beginStep(x, x, true);
    const std::vector<ContactSample> samples = self.contact->samples(x);
    ASSERT_GT(samples.size(), 5u) << nameOf(options);
    const double deep = kHeight - pitch;
    double deepest = 0.0;
    for (const ContactSample& s : samples)
    {
      deepest = std::max(deepest, s.depth);
      const Tet& t = self.body.mesh.tets[s.host];
      const auto coords = tetCoordinates(x[t[0]], x[t[1]], x[t[2]], x[t[3]]);
      ASSERT_TRUE(coords);
      EXPECT_GT(coords->weights(s.position).minCoeff(), -1e-9) << "it stands in its tet";
    }
    std::printf("  %s: deepest %.2f mm of %.2f mm\n", nameOf(options).c_str(), 1e3 * deepest,
                1e3 * deep);
    EXPECT_LT(deepest, 1.4 * deep) << nameOf(options);
    EXPECT_GT(deepest, 0.4 * deep) << nameOf(options);
    const NodalSums sums(*self.contact, x);
    EXPECT_LT(sums.force.norm(), 1e-12 * sums.force_size) << nameOf(options);
    EXPECT_LT(sums.moment.norm(), 1e-12 * sums.moment_size) << nameOf(options);
    EXPECT_LT(self.contact->value(rolledUp(self.body.mesh.nodes, kLength, 1.1 * pitch)),
              0.7 * self.contact->value(x))
        << "wider turns are less deep in each other";
    RandomGeometry random(72);
    EXPECT_LT(gradientError(*self.contact, x, random), 1e-6) << nameOf(options);
  }
}

}  // namespace soft_tissue::test
