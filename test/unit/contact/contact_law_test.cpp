#include <gtest/gtest.h>

#include "soft_tissue_sim/mesh/generate.h"
#include "support/contact_derivatives.h"
#include "support/tissue_pair.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kRadius = 0.006, kPenalty = 40.0;
const Vec3 kCentre(0.011, 0.009, 0.0045);

ContactOptions lawOf(ContactLaw law, bool segments)
{
  ContactOptions options;
  options.law = law;
  options.segments = segments;
  options.stiffness_pa_per_m = kPenalty;
  return options;
}

double depthOf(const Vec3& p)
{
  return std::max(0.0, kRadius - (p - kCentre).norm());
}

/** Integral of the square of the depth along an edge, m^3, by many small parts. */
double squareAlong(const Vec3& a, const Vec3& b)
{
  constexpr int kParts = 20000;
  double sum = 0.0;
  for (int k = 0; k < kParts; ++k)
  {
    const double depth = depthOf(a + (k + 0.5) / kParts * (b - a));
    sum += depth * depth;
  }
  return sum / kParts * (b - a).norm();
}

/** A ball that touches a sheet of unequal triangles from above. */
struct BallOnSheet
{
  TriMesh mesh = makeSheet({7, 6}, {0.02, 0.02}, SheetPattern::irregular);
  BoundarySurface surface = surfaceOf(Index(mesh.nodes.size()), mesh.triangles);
  RigidBodyShape ball;
  std::unique_ptr<ToolContact> contact;

  explicit BallOnSheet(const ContactOptions& options)
  {
    ball.add(makeSphere(kRadius), Pose::Identity());
    const TissueBody body = {nullptr, &surface, 0, Index(mesh.nodes.size())};
    contact = std::make_unique<ToolContact>(body, ball, nullptr, options);
    contact->beginStep(mesh.nodes, at(kCentre), at(kCentre), true);
  }
};

TEST(ContactLaw, OfFisherIsTheSquareOfEachNodesDepth)
{
  BallOnSheet scene(lawOf(ContactLaw::fisher2001, false));
  double expected = 0.0;
  for (const Vec3& p : scene.mesh.nodes)
  {
    expected += kPenalty * depthOf(p) * depthOf(p);
  }
  ASSERT_GT(expected, 0.0);
  EXPECT_NEAR(scene.contact->value(scene.mesh.nodes), expected, 1e-12 * expected);
}

TEST(ContactLaw, OfMarchalIsDepthTimesPenaltyAtNodes)
{
  BallOnSheet scene(lawOf(ContactLaw::marchal2004, false));
  const std::vector<ContactSample>& samples = scene.contact->samples(scene.mesh.nodes);
  ASSERT_GT(samples.size(), 3u);
  for (const ContactSample& sample : samples)
  {
    EXPECT_NEAR(sample.force, kPenalty * depthOf(sample.position), 1e-12 * kPenalty * kRadius);
  }
}

TEST(ContactLaw, OfMarchalIsIntegratedAlongEdges)
{
  BallOnSheet scene(lawOf(ContactLaw::marchal2004, true));
  double expected = 0.0;
  for (const Edge& edge : scene.surface.edges)
  {
    expected += 0.5 * kPenalty * squareAlong(scene.mesh.nodes[edge[0]], scene.mesh.nodes[edge[1]]);
  }
  ASSERT_GT(expected, 0.0);
  EXPECT_NEAR(scene.contact->value(scene.mesh.nodes), expected, 0.01 * expected);
}

// Both directions count whole: twice what their mean is.
TEST(ContactLaw, OfThePapersCountsBothDirections)
{
  const TetMesh below = slab(Vec3(0, 0, -0.01), Vec3(0.012, 0.012, 0.0), 3, 3, 2);
  const TetMesh above = slab(Vec3(0.001, 0.001, -0.001), Vec3(0.011, 0.011, 0.009), 2, 2, 2);
  TissuePair pair(below, above, lawOf(ContactLaw::fisher2001, false));
  pair.contact->beginStep(pair.x, pair.x, true);
  int from_below = 0, from_above = 0;
  for (const ContactSample& sample : pair.contact->samples(pair.x))
  {
    (sample.side > 0 ? from_below : from_above) += 1;
    EXPECT_NEAR(sample.force, 2.0 * kPenalty * 0.001, 1e-12);
  }
  EXPECT_EQ(from_below, 4);  // the inner nodes of 3 x 3 cells
  EXPECT_EQ(from_above, 9);
}

TEST(ContactLaw, OfThePapersHasItsForceForGradient)
{
  for (const ContactOptions& options :
       {lawOf(ContactLaw::fisher2001, false), lawOf(ContactLaw::marchal2004, true)})
  {
    RandomGeometry random(5);
    ContactScene scene(slab(Vec3::Zero(), Vec3(0.02, 0.02, 0.01), 4, 4, 2), makeSphere(0.004),
                       options);
    const Points start = shaken(scene.mesh.nodes, 0.0004, 6);
    scene.begin(start, at({0.0102, 0.0097, 0.0115}));
    const Points x = shaken(start, 0.0001, 7);
    ASSERT_GT(scene.contact->samples(x).size(), 3u);
    EXPECT_LT(gradientError(*scene.contact, x, random), 1e-6);
  }
}

}  // namespace
}  // namespace soft_tissue::test
