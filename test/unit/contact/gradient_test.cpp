#include <gtest/gtest.h>

#include <cstdio>

#include "support/contact_derivatives.h"
#include "support/contact_scene.h"

namespace soft_tissue::test
{
namespace
{
const Vec3 kSlab(0.028, 0.028, 0.014);

TetMesh tissue()
{
  return slab(Vec3::Zero(), kSlab, 4, 4, 2);
}

Pose randomPress(RandomGeometry& random)
{
  Pose X = random.pose(0.0);
  X.translation() = Vec3(random.uniform(0.01, 0.018), random.uniform(0.01, 0.018),
                         kSlab.z() + random.uniform(-0.002, 0.001));
  return X;
}

double worstOver(const std::shared_ptr<const RigidShape>& shape, const ContactOptions& options)
{
  double worst = 0.0;
  for (unsigned seed = 0; seed < 4; ++seed)
  {
    RandomGeometry random(seed);
    ContactScene scene(tissue(), shape, options);
    const Points start = shaken(scene.mesh.nodes, 0.0005, seed + 10);
    scene.begin(start, randomPress(random));
    const Points x = shaken(start, 0.0002, seed + 20);
    EXPECT_GT(scene.contact->samples(x).size(), 5u);
    worst = std::max(worst, gradientError(*scene.contact, x, random));
  }
  return worst;
}
}  // namespace

TEST(ContactGradient, IsTheDerivativeOfTheValue)
{
  SurfaceMesh bent = lPrism();
  for (Vec3& node : bent.nodes)
  {
    node = 0.004 * (node - Vec3(0.7, 0.7, 0.5));
  }
  const std::vector<std::shared_ptr<const RigidShape>> shapes = {
      makeMeshShape(bent.nodes, bent.triangles, "bent tool"), makeSphere(0.004),
      makeCapsule(0.003, 0.01), makeBox({0.006, 0.005, 0.008})};
  for (const ContactOptions& options : contactModels(1e6))
  {
    double worst = 0.0;
    for (const auto& shape : shapes)
    {
      worst = std::max(worst, worstOver(shape, options));
    }
    std::printf("  %s: off its difference by at most %.1e\n", nameOf(options).c_str(), worst);
    EXPECT_LT(worst, 1e-6) << nameOf(options);
  }
}

TEST(ContactGradient, AddsToWhatIsThere)
{
  ContactScene scene(tissue(), makeSphere(0.004), contactModels(1e6)[3]);
  scene.begin(scene.mesh.nodes, at({0.0141, 0.0138, 0.016}));
  Points twice(scene.mesh.nodes.size(), Vec3::Ones());
  scene.contact->addGradient(scene.mesh.nodes, twice);
  scene.contact->addGradient(scene.mesh.nodes, twice);
  const Eigen::VectorXd once = gradientOf(*scene.contact, scene.mesh.nodes);
  ASSERT_GT(once.norm(), 0.0);
  for (Eigen::Index k = 0; k < once.size(); ++k)
  {
    EXPECT_NEAR(twice[k / 3][k % 3], 1.0 + 2.0 * once[k], 1e-12);
  }
}

TEST(ContactGradient, BalancesTheToolInForceAndMoment)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    RandomGeometry random(31);
    ContactScene scene(tissue(), makeCapsule(0.003, 0.01), options);
    const Points x = shaken(scene.mesh.nodes, 0.0007, 32);
    scene.begin(x, randomPress(random));
    Points gradient(x.size(), Vec3::Zero());
    scene.contact->addGradient(x, gradient);
    Vec3 force = Vec3::Zero();
    Vec3 moment = Vec3::Zero();
    addToolWrench(scene.contact->samples(x), Vec3::Zero(), force, moment);
    const double force_size = force.norm();
    const double moment_size = moment.norm();
    ASSERT_GT(force_size, 0.0);
    EXPECT_GT(force.z(), 0.0) << "the tissue pushes the tool out";
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      force -= gradient[i];
      moment -= x[i].cross(gradient[i]);
    }
    EXPECT_LT(force.norm(), 1e-9 * force_size) << nameOf(options);
    EXPECT_LT(moment.norm(), 1e-9 * moment_size) << nameOf(options);
  }
}

}  // namespace soft_tissue::test
