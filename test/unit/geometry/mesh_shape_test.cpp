#include <gtest/gtest.h>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/geometry/rigid_shape.h"
#include "support/geometry_oracle.h"

namespace soft_tissue
{
namespace
{
using test::RandomGeometry;

SurfaceMesh tetSurface()
{
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
}

void append(SurfaceMesh& mesh, const SurfaceMesh& other, const Vec3& offset)
{
  const Index first = static_cast<Index>(mesh.nodes.size());
  for (const Vec3& node : other.nodes)
  {
    mesh.nodes.push_back(node + offset);
  }
  for (const Triangle& t : other.triangles)
  {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

/** The message of the Error that making this solid throws; empty if it throws none. */
std::string refusal(const SurfaceMesh& mesh)
{
  try
  {
    makeMeshShape(mesh.nodes, mesh.triangles, "tool.stl");
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

void expectRefused(const SurfaceMesh& mesh, const std::string& reason)
{
  const std::string message = refusal(mesh);
  EXPECT_NE(message.find("tool.stl"), std::string::npos) << message;
  EXPECT_NE(message.find(reason), std::string::npos) << message;
}

TEST(MeshShape, RefusesSurfacesThatBoundNoSolid)
{
  EXPECT_EQ(refusal(tetSurface()), "");
  expectRefused({}, "no triangles");

  SurfaceMesh mesh = tetSurface();
  mesh.triangles.pop_back();
  expectRefused(mesh, "open surface");

  mesh = tetSurface();
  std::swap(mesh.triangles[2][0], mesh.triangles[2][1]);
  expectRefused(mesh, "oriented oppositely");

  mesh = tetSurface();
  for (Triangle& t : mesh.triangles)
  {
    std::swap(t[0], t[1]);
  }
  expectRefused(mesh, "wound inward");

  mesh = tetSurface();
  mesh.triangles.push_back(mesh.triangles[0]);
  expectRefused(mesh, "non-manifold");

  mesh = tetSurface();
  mesh.triangles[1][0] = 4;
  expectRefused(mesh, "names node 4");

  mesh = tetSurface();
  mesh.triangles[1][0] = -1;
  expectRefused(mesh, "names node -1");

  mesh = tetSurface();
  mesh.nodes[3].z() = NAN;
  expectRefused(mesh, "node 3 is not finite");

  mesh = tetSurface();
  mesh.nodes[3] = {0.5, 0, 0};
  expectRefused(mesh, "has no area");
}

TEST(MeshShape, RefusesSolidsThatTouchInANode)
{
  SurfaceMesh mesh = tetSurface();
  SurfaceMesh other = tetSurface();
  append(mesh, other, {-5, 0, 0});
  EXPECT_EQ(refusal(mesh), "");
  for (Triangle& t : mesh.triangles)
  {
    for (Index& node : t)
    {
      node = node == 4 ? 0 : node;
    }
  }
  mesh.nodes[5] = {-1, 0, 0};
  mesh.nodes[6] = {0, -1, 0};
  mesh.nodes[7] = {0, 0, 1.5};
  expectRefused(mesh, "touch in that point only");
}

TEST(MeshShape, SignIsRightBesideSharpEdgesAndCorners)
{
  // Thin wedge: outside points near its sharp edge have it as nearest feature.
  SurfaceMesh wedge;
  wedge.nodes = {{0, 0, 0}, {1, 0, 0.01}, {1, 0, -0.01}, {0, 1, 0}, {1, 1, 0.01}, {1, 1, -0.01}};
  wedge.triangles = {{0, 1, 4}, {0, 4, 3}, {0, 5, 2}, {0, 3, 5},
                     {1, 2, 5}, {1, 5, 4}, {0, 2, 1}, {3, 4, 5}};
  ASSERT_TRUE(test::isClosed(wedge));
  const auto shape = makeMeshShape(wedge.nodes, wedge.triangles, "wedge");
  RandomGeometry random(8);
  for (int trial = 0; trial < 3000; ++trial)
  {
    Vec3 p = wedge.nodes[trial % 6] + random.point(trial % 2 == 0 ? 0.5 : 0.02);
    if (trial % 3 == 0)
    {
      p.y() = 0.5 + random.uniform(-0.4, 0.4);
    }
    const double winding = test::windingNumber(p, wedge);
    EXPECT_EQ(shape->distance(p).distance<0.0, winding> 0.5) << p.transpose();
  }
  EXPECT_TRUE(shape->convex());
}

TEST(MeshShape, SeveralPiecesAndCavitiesKeepTheirSigns)
{
  SurfaceMesh shell = makeBox({2, 2, 2})->surface(1.0);
  SurfaceMesh cavity = makeBox({1, 1, 1})->surface(1.0);
  for (Triangle& t : cavity.triangles)
  {
    std::swap(t[0], t[1]);
  }
  append(shell, cavity, Vec3::Zero());
  append(shell, makeBox({1, 1, 1})->surface(1.0), {5, 0, 0});
  const auto shape = makeMeshShape(shell.nodes, shell.triangles, "shell");
  EXPECT_NEAR(shape->distance({0, 0, 0.1}).distance, 0.4, 1e-12);
  EXPECT_NEAR(shape->distance({0, 0, 0.7}).distance, -0.2, 1e-12);
  EXPECT_NEAR(shape->distance({5, 0.1, 0.2}).distance, -0.3, 1e-12);
  EXPECT_NEAR(shape->distance({3, 0, 0}).distance, 1.5, 1e-12);
  EXPECT_FALSE(shape->convex());
}

TEST(MeshShape, SplitsOnlyEdgesThatAreTooLong)
{
  const SurfaceMesh prism = test::lPrism();
  const auto shape = makeMeshShape(prism.nodes, prism.triangles, "prism");
  EXPECT_EQ(shape->surface(10.0).triangles, prism.triangles);
  const SurfaceMesh fine = shape->surface(0.5);
  EXPECT_GT(fine.triangles.size(), 4 * prism.triangles.size());
  EXPECT_NEAR(test::surfaceArea(fine), 14.0, 1e-12);
  EXPECT_NEAR(test::enclosedVolume(fine), 3.0, 1e-12);
}

}  // namespace
}  // namespace soft_tissue
