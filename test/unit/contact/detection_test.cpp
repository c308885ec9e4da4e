#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/contact/tool_surface.h"
#include "soft_tissue_sim/geometry/clip.h"
#include "support/contact_scene.h"
#include "support/finite_difference.h"

namespace soft_tissue::test
{
namespace
{
TetMesh tissue()
{
  return slab(Vec3::Zero(), {0.028, 0.028, 0.014}, 4, 4, 2);
}
const Vec3 kTop(0.0143, 0.0138, 0.014);

Vec3 forceOnTool(ContactScene& scene, const Points& x)
{
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  addToolWrench(scene.contact->samples(x), Vec3::Zero(), force, torque);
  return force;
}

/** Energy of a ridge along y pressed from below by a bar along x whose top edge meets it crosswise.
 */
TetMesh ridge()
{
  TetMesh mesh;
  mesh.nodes = {{0, -1, 0}, {0, 1, 0}, {-1, 0, -1}, {1, 0, -1}};
  mesh.tets = {{0, 1, 2, 3}};
  if (signedVolume6(mesh.nodes[0], mesh.nodes[1], mesh.nodes[2], mesh.nodes[3]) < 0.0)
  {
    std::swap(mesh.tets[0][2], mesh.tets[0][3]);
  }
  mesh.tags = {0};
  return mesh;
}
}  // namespace

TEST(ToolContactDetection, CostsNothingWithoutOverlap)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    ContactScene scene(tissue(), makeSphere(0.004), options);
    const Points& x = scene.mesh.nodes;
    scene.begin(x, at({0.0143, 0.0138, 0.03}));
    EXPECT_FALSE(scene.contact->active());
    EXPECT_EQ(scene.contact->value(x), 0.0);
    EXPECT_EQ(gradientOf(*scene.contact, x).norm(), 0.0);
    EXPECT_TRUE(scene.contact->samples(x).empty());
    EXPECT_EQ(scene.marches, 0);
    EXPECT_TRUE(std::isnan(scene.contact->depth()[0]));

    scene.begin(x, at({0.0143, 0.0138, 0.0185}));  // near, but apart: still no field
    EXPECT_TRUE(scene.contact->active());
    EXPECT_EQ(scene.contact->value(x), 0.0);
    EXPECT_EQ(scene.marches, 0);
  }
}

TEST(ToolContactDetection, MarchesOncePerStepAndKeepsTheFieldWhenAsked)
{
  ContactScene scene(tissue(), makeSphere(0.004), contactModels(1e6)[2]);
  Points x = scene.mesh.nodes;
  scene.begin(x, at(kTop));
  const double first = scene.contact->value(x);
  x[0].x() -= 1e-4;
  scene.contact->value(x);
  EXPECT_EQ(scene.marches, 1);
  scene.contact->beginStep(scene.mesh.nodes, at(kTop), at(kTop), false);
  EXPECT_EQ(scene.contact->value(scene.mesh.nodes), first);
  EXPECT_EQ(scene.marches, 1);
}

TEST(ToolContactDetection, FindsAllContactsWhenTheTissueMovesFurtherThanExpected)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    ContactScene scene(tissue(), makeSphere(0.004), options);
    Points moved = scene.mesh.nodes;
    for (Vec3& p : moved)
    {
      p += Vec3(0.009, -0.007, 0.003);
    }
    scene.begin(moved, at(kTop));
    const double wanted = scene.contact->value(moved);
    scene.begin(scene.mesh.nodes, at(kTop));
    EXPECT_NE(scene.contact->value(scene.mesh.nodes), wanted);
    EXPECT_NEAR(scene.contact->value(moved), wanted, 1e-9 * wanted) << nameOf(options);
  }
}

TEST(ToolContactDetection, CoversExactlyTheLengthOfEdgesInTheTissue)
{
  for (const bool closest : {false, true})
  {
    ContactOptions options = contactModels(1e6)[2];
    options.closest_feature = closest;
    ContactScene scene(tissue(), makeCapsule(0.004, 0.01), options);
    const Points x = shaken(scene.mesh.nodes, 0.0006, 51);
    RandomGeometry random(52);
    Pose X = random.pose(0.0);
    X.translation() = kTop;
    scene.begin(x, X);
    double area = 0.0;
    for (const ContactSample& s : scene.contact->samples(x))
    {
      area += s.side > 0 ? s.area : 0.0;
    }
    double wanted = 0.0;
    const ToolSurface surface = sampleToolSurface(scene.tool);
    for (std::size_t e = 0; e < surface.edges.size(); ++e)
    {
      for (const Tet& t : scene.mesh.tets)
      {
        const auto coords = tetCoordinates(x[t[0]], x[t[1]], x[t[2]], x[t[3]]);
        const auto piece = clipSegment(X * surface.nodes[surface.edges[e][0]],
                                       X * surface.nodes[surface.edges[e][1]], *coords);
        wanted += piece ? 0.5 * surface.edge_area[e] * (piece->lambda2 - piece->lambda1) : 0.0;
      }
    }
    ASSERT_GT(wanted, 0.0);
    EXPECT_NEAR(area, wanted, 1e-9 * wanted);
  }
}

TEST(ToolContactDetection, SeparatesEdgesThatCrossWithoutAnyPointInside)
{
  ContactOptions options = contactModels(1e6)[1];  // points
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(0.25 * 3.14159265358979323846, Vec3::UnitX()).toRotationMatrix();
  const double half_diagonal = 0.5 * std::sqrt(2.0) * 0.3;
  constexpr double kDepth = 0.002;
  X.translation() = Vec3(0, 0.0234, half_diagonal - kDepth);  // a bar along x on the ridge
  ContactScene points(ridge(), makeBox({3, 0.3, 0.3}), options);
  double nearest = 1.0;  // the node beyond the middle: the ridge shall meet the bar half way to it
  for (const Vec3& node : sampleToolSurface(points.tool).nodes)
  {
    nearest = node.x() > 1e-9 ? std::min(nearest, node.x()) : nearest;
  }
  ASSERT_GT(nearest, 4.0 * kDepth);
  X.translation().x() = 0.5 * nearest;
  points.begin(points.mesh.nodes, X);
  options.segments = true;
  ContactScene segments(ridge(), makeBox({3, 0.3, 0.3}), options);
  segments.begin(segments.mesh.nodes, X);
  EXPECT_EQ(points.contact->value(points.mesh.nodes), 0.0);
  EXPECT_GT(forceOnTool(segments, segments.mesh.nodes).z(), 0.0);
}

TEST(ToolContactDetection, PushesADeepToolAndAnEngulfedTissueOut)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    ContactScene deep(slab(Vec3::Zero(), {0.03, 0.03, 0.02}, 6, 6, 4), makeSphere(0.002), options);
    deep.begin(deep.mesh.nodes, at({0.0147, 0.0152, 0.0155}));  // nearest to the top
    const Vec3 force = forceOnTool(deep, deep.mesh.nodes);
    EXPECT_TRUE(force.allFinite());
    EXPECT_GT(force.z(), 0.9 * force.norm()) << nameOf(options);

    ContactScene inside(slab({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, 3, 3, 3), makeSphere(0.05),
                        options);
    inside.begin(inside.mesh.nodes, at({0, 0, -0.02}));
    const Vec3 push = forceOnTool(inside, inside.mesh.nodes);
    EXPECT_TRUE(push.allFinite());
    EXPECT_LT(push.z(), -0.9 * push.norm()) << nameOf(options);
  }
}

TEST(ToolContactDetection, StaysFiniteWithFlatAndInvertedTets)
{
  for (const ContactOptions& options : contactModels(1e6))
  {
    ContactScene scene(tissue(), makeSphere(0.004), options);
    Points x = scene.mesh.nodes;
    for (Vec3& p : x)  // a plane of nodes squeezed onto the next, one turned through it
    {
      p.z() = p.z() < 0.01 ? p.z() : 0.007;
    }
    x[x.size() / 2].z() = 0.012;
    for (const double height : {0.006, 0.009})
    {
      scene.begin(x, at({0.0143, 0.0138, height}));
      EXPECT_TRUE(std::isfinite(scene.contact->value(x)));
      EXPECT_TRUE(gradientOf(*scene.contact, x).allFinite()) << nameOf(options);
      EXPECT_TRUE(hessianOf(*scene.contact, x, scene.node_neighbours).allFinite());
    }
  }
}

TEST(ToolContactDetection, WorksInRowsOfALargerScene)
{
  ContactScene scene(tissue(), makeSphere(0.004), contactModels(1e6)[3]);
  scene.begin(scene.mesh.nodes, at(kTop));
  const double wanted = scene.contact->value(scene.mesh.nodes);
  const TissueBody body = {&scene.mesh.tets, &scene.surface, 2, Index(scene.mesh.nodes.size())};
  ToolContact contact(body, scene.tool, std::make_unique<ExhaustiveField>(scene.surface),
                      contactModels(1e6)[3]);
  Points x(2, Vec3::Zero());
  x.insert(x.end(), scene.mesh.nodes.begin(), scene.mesh.nodes.end());
  contact.beginStep(x, at(kTop), at(kTop), true);
  EXPECT_EQ(contact.value(x), wanted);
  for (const ContactSample& s : contact.samples(x))
  {
    EXPECT_GE(*std::min_element(s.node.begin(), s.node.begin() + s.count), 2);
  }
}

}  // namespace soft_tissue::test
