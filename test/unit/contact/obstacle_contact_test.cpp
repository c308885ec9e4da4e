#include "soft_tissue_sim/contact/obstacle_contact.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "support/contact_derivatives.h"
#include "support/contact_scene.h"
#include "support/voxel_samples.h"

namespace soft_tissue::test
{
namespace
{
constexpr double kCell = 0.003;

/** A slab of tissue pressed onto a bumpy floor of voxels. */
struct BumpyFloor
{
  TetMesh mesh = slab(Vec3::Zero(), Vec3(0.028, 0.028, 0.014), 4, 4, 2);
  BoundarySurface surface = extractBoundary(Index(mesh.nodes.size()), mesh.tets);
  Adjacency neighbours = nodeNeighbours(Index(mesh.nodes.size()), mesh.tets);
  ObstacleContact contact;

  explicit BumpyFloor(const ContactOptions& options)
      : contact({&mesh.tets, &surface, 0, Index(mesh.nodes.size())}, floor(), at({0.0, 0.0, 0.001}),
                options)
  {}

  static std::shared_ptr<VoxelShape> floor()
  {
    const CellBox box = {Cell(-4, -4, -3), Cell(14, 14, 2)};
    return std::make_shared<VoxelShape>(voxelsOf(kCell, box, [](const Vec3& p) {
      return p.z() < 0.002 * std::sin(300.0 * p.x()) * std::cos(200.0 * p.y()) - 0.0005;
    }));
  }
};

std::vector<ContactOptions> models()
{
  const std::vector<ContactOptions> all = contactModels(1e6);
  return {all[1], all[3]};  // points and segments; nothing depends on the tissue's depth
}

TEST(ObstacleContact, ItsGradientIsTheDerivativeOfItsValue)
{
  for (const ContactOptions& options : models())
  {
    double worst = 0.0;
    for (unsigned seed = 0; seed < 4; ++seed)
    {
      RandomGeometry random(seed);
      BumpyFloor scene(options);
      const Points start = shaken(scene.mesh.nodes, 0.0005, seed + 10);
      scene.contact.beginStep(start);
      const Points x = shaken(start, 0.0002, seed + 20);
      EXPECT_GT(scene.contact.samples(x).size(), 5u);
      worst = std::max(worst, gradientError(scene.contact, x, random));
    }
    std::printf("  %s: off its difference by at most %.1e\n", nameOf(options).c_str(), worst);
    EXPECT_LT(worst, 1e-6) << nameOf(options);
  }
}

// Nodes have no clip points: the Hessian is exact.
TEST(ObstacleContact, ItsHessianIsTheDerivativeOfItsGradientAtNodes)
{
  BumpyFloor scene(models()[0]);
  const Points x = shaken(scene.mesh.nodes, 0.0005, 3);
  scene.contact.beginStep(x);
  const Eigen::MatrixXd found = hessianOf(scene.contact, x, scene.neighbours, Curvature::exact);
  const Eigen::MatrixXd expected = centralDifference(scene.contact, x);
  ASSERT_GT(expected.norm(), 0.0);
  EXPECT_LT((found - expected).norm(), 1e-5 * expected.norm());
}

TEST(ObstacleContact, CountsTheWholeAreaOfATissueOnAFlatFloor)
{
  for (const ContactOptions& options : models())
  {
    const TetMesh mesh = slab(Vec3::Zero(), Vec3(0.028, 0.028, 0.014), 4, 4, 2);
    const BoundarySurface surface = extractBoundary(Index(mesh.nodes.size()), mesh.tets);
    const auto floor = std::make_shared<VoxelShape>(
        voxelsOf(kCell, {Cell(-10, -10, -3), Cell(20, 20, 0)}, [](const Vec3&) { return true; }));
    constexpr double kDepth = 1e-4;
    ObstacleContact contact({&mesh.tets, &surface, 0, Index(mesh.nodes.size())}, floor,
                            at({0.0, 0.0, kDepth}), options);
    contact.beginStep(mesh.nodes);
    const double pressed = 0.5 * 1e6 * kDepth * kDepth * 0.028 * 0.028;
    // Edges and nodes at the rim stand for a piece of the sides as well.
    EXPECT_GE(contact.value(mesh.nodes), pressed * (1.0 - 1e-9)) << nameOf(options);
    EXPECT_LE(contact.value(mesh.nodes), pressed * 1.6) << nameOf(options);
    double force = 0.0;
    for (const ContactSample& sample : contact.samples(mesh.nodes))
    {
      force += sample.forceOnFirst().z();
    }
    EXPECT_LE(force, -1e6 * kDepth * 0.028 * 0.028 * (1.0 - 1e-9)) << nameOf(options);
  }
}

TEST(ObstacleContact, IsNotActiveOutOfReach)
{
  BumpyFloor scene(models()[1]);
  Points x = scene.mesh.nodes;
  for (Vec3& p : x)
  {
    p.z() += 0.02;
  }
  scene.contact.beginStep(x);
  EXPECT_FALSE(scene.contact.active());
  EXPECT_EQ(scene.contact.value(x), 0.0);
}

// What is searched anew on the way has to find what a step from there would have found.
TEST(ObstacleContact, FindsWhatALongWayWithinAStepLeadsTo)
{
  for (const ContactOptions& options : models())
  {
    BumpyFloor scene(options), other(options);
    const Points x = shaken(scene.mesh.nodes, 0.0005, 5);
    Points high = x;
    for (Vec3& p : high)
    {
      p.z() += 0.0021;
    }
    scene.contact.beginStep(high);
    ASSERT_TRUE(scene.contact.active());
    other.contact.beginStep(x);
    EXPECT_EQ(scene.contact.samples(x).size(), other.contact.samples(x).size());
    EXPECT_GT(scene.contact.samples(x).size(), 0u);
  }
}

}  // namespace
}  // namespace soft_tissue::test
