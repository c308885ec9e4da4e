#include <gtest/gtest.h>

#include <cstdio>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "support/contact_derivatives.h"
#include "support/tissue_pair.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kSide = 0.04, kKappa = 1e6, kRadius = 0.005;

/** A square membrane around the z axis, and how contact sees it. */
struct Membrane
{
  TriMesh mesh;
  BoundarySurface surface;
  SurfacePoints points;

  Membrane(int cells, double height, double longest_edge)
      : mesh(makeSheet({cells, cells}, {kSide, kSide}, SheetPattern::irregular))
  {
    for (Vec3& p : mesh.nodes)
    {
      p += Vec3(-0.5 * kSide, -0.5 * kSide, height);
    }
    surface = surfaceOf(Index(mesh.nodes.size()), mesh.triangles);
    points = cutSurface(mesh, longest_edge);
  }

  TissueBody body(bool cut) const
  {
    TissueBody body = {nullptr, cut ? &points.surface : &surface, 0, Index(mesh.nodes.size())};
    body.short_edge = 0.004;
    body.points = cut ? &points : nullptr;
    return body;
  }
};

/** Force that a plane `h` beside the centre of a ball has on it: kappa times the integral of
 * (R - rho) h / rho over the disc, rho = sqrt(r^2 + h^2). */
double forceOnBall(double h)
{
  // With rho d rho = r dr: 2 pi kappa h times the integral of R - rho from h to R.
  return 2.0 * EIGEN_PI * kKappa * h * 0.5 * (kRadius - h) * (kRadius - h);
}

struct BallOnMembrane
{
  Membrane membrane;
  RigidBodyShape ball;
  std::unique_ptr<ToolContact> contact;
  Points x;

  BallOnMembrane(int cells, const ContactOptions& options, bool cut = true)
      : membrane(cells, 0.0, 0.5 * kRadius), x(membrane.mesh.nodes)
  {
    ball.add(makeSphere(kRadius), Pose::Identity());
    contact = std::make_unique<ToolContact>(membrane.body(cut), ball, nullptr, options);
  }
};

// Away from the edges of two triangles 40 mm long: contact has to look at more than nodes and
// edges.
TEST(MembraneContact, AToolPressesOnTheMiddleOfALargeTriangle)
{
  const double depth = 0.0015;
  const double expected = forceOnBall(kRadius - depth);
  const Pose X_WT = at({0.012, 0.0, kRadius - depth});
  for (const ContactOptions& options : {contactModels(kKappa)[1], contactModels(kKappa)[3]})
  {
    BallOnMembrane scene(1, options), uncut(1, options, false);
    scene.contact->beginStep(scene.x, X_WT, X_WT, true);
    uncut.contact->beginStep(scene.x, X_WT, X_WT, true);
    EXPECT_TRUE(uncut.contact->samples(scene.x).empty());
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    addToolWrench(scene.contact->samples(scene.x), X_WT.translation(), force, torque);
    std::printf("  %s: %.4f N of %.4f\n", nameOf(options).c_str(), force.z(), expected);
    EXPECT_NEAR(force.z(), expected, (options.segments ? 0.05 : 0.15) * expected);
    NodalSums nodes(*scene.contact, scene.x);
    EXPECT_LT((nodes.force + force).norm(), 1e-12 * expected);
    EXPECT_LT((nodes.moment + torque + X_WT.translation().cross(force)).norm(),
              1e-12 * expected * kSide);
  }
}

TEST(MembraneContact, ItsGradientWithAToolIsTheDerivativeOfItsValue)
{
  for (const ContactOptions& options : {contactModels(kKappa)[1], contactModels(kKappa)[3]})
  {
    double worst = 0.0;
    for (unsigned seed = 0; seed < 4; ++seed)
    {
      RandomGeometry random(seed);
      BallOnMembrane scene(3, options);
      const Pose X_WT = at({0.003, -0.002, 0.003});
      const Points start = shaken(scene.x, 0.0005, seed + 10);
      scene.contact->beginStep(start, X_WT, X_WT, true);
      const Points x = shaken(start, 0.0002, seed + 20);
      ASSERT_GT(scene.contact->samples(x).size(), 5u);
      worst = std::max(worst, gradientError(*scene.contact, x, random));
    }
    std::printf("  %s: off its difference by at most %.1e\n", nameOf(options).c_str(), worst);
    EXPECT_LT(worst, 1e-6) << nameOf(options);
  }
}

/** A membrane of large triangles under the top of a slab of smaller cells. */
struct MembraneInSlab
{
  static constexpr double kHigh = 0.012, kShort = 0.004;
  Membrane membrane;
  PairedBody tissue;
  Points x;
  std::unique_ptr<TissueContact> contact;

  MembraneInSlab(double depth, const ContactOptions& options)
      : membrane(1, -depth, kShort),
        tissue(slab(Vec3(-0.03, -0.03, -kHigh), Vec3(0.03, 0.03, 0.0), 15, 15, 3),
               Index(membrane.mesh.nodes.size())),
        x(membrane.mesh.nodes)
  {
    x.insert(x.end(), tissue.mesh.nodes.begin(), tissue.mesh.nodes.end());
    contact = std::make_unique<TissueContact>(TissueContact::Side{membrane.body(true), nullptr},
                                              tissue.side(kShort), options);
  }
};

TEST(MembraneContact, ItsPressureInATissueIsStiffnessTimesDepth)
{
  const double depth = 0.001;
  const double expected = kKappa * depth * kSide * kSide;
  for (const ContactOptions& options : contactModels(kKappa))
  {
    MembraneInSlab scene(depth, options);
    scene.contact->beginStep(scene.x, scene.x, true);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    addToolWrench(scene.contact->samples(scene.x), Vec3::Zero(), force, torque);
    EXPECT_NEAR(force.z(), expected, 1e-9 * expected) << nameOf(options);
    NodalSums sums(*scene.contact, scene.x);
    EXPECT_LT(sums.force.norm(), 1e-12 * sums.force_size) << nameOf(options);
    EXPECT_LT(sums.moment.norm(), 1e-12 * sums.moment_size) << nameOf(options);
  }
}

TEST(MembraneContact, ItsGradientInATissueIsTheDerivativeOfItsValue)
{
  for (const ContactOptions& options : contactModels(kKappa))
  {
    double worst = 0.0;
    for (unsigned seed = 0; seed < 3; ++seed)
    {
      RandomGeometry random(seed);
      MembraneInSlab scene(0.001, options);
      const Points start = shaken(scene.x, 0.0004, seed + 10);
      scene.contact->beginStep(start, start, true);
      const Points x = shaken(start, 0.0001, seed + 20);
      ASSERT_GT(scene.contact->samples(x).size(), 20u);
      worst = std::max(worst, gradientError(*scene.contact, x, random));
    }
    std::printf("  %s: off its difference by at most %.1e\n", nameOf(options).c_str(), worst);
    EXPECT_LT(worst, 2e-6) << nameOf(options);
  }
}

TEST(MembraneContact, NothingCanBeInsideAMembrane)
{
  const Membrane membrane(1, 0.0, 1.0);
  PairedBody tissue(slab(Vec3::Zero(), Vec3::Ones(), 1, 1, 1), 4);
  EXPECT_THROW(TissueContact(tissue.side(0.1), {membrane.body(false), nullptr}, ContactOptions()),
               Error);
}

}  // namespace
}  // namespace soft_tissue::test
