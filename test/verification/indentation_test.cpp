#include "indentation.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "support/mesh_file_content.h"

namespace soft_tissue::studies
{
namespace
{
std::vector<IndentationMesh> boxes(const std::vector<int>& cells)
{
  std::vector<IndentationMesh> meshes(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    meshes[i].cells = cells[i];
  }
  return meshes;
}

std::vector<IndentationMesh> rings(const std::vector<int>& around, ElementKind element)
{
  std::vector<IndentationMesh> meshes(around.size());
  for (std::size_t i = 0; i < around.size(); ++i)
  {
    meshes[i].around = around[i];
    meshes[i].element = element;
  }
  return meshes;
}

/** Presses into meshes, each finer than the one before; expects the error of the force to fall with
 * some order and to lead to less than the given share where cells vanish. Returns the last. */
double expectForce(const Indentation& problem, const std::vector<IndentationMesh>& meshes,
                   double least_order, double most_in_the_limit)
{
  const test::ScratchFolder folder;
  std::vector<double> errors, sizes;
  for (const IndentationMesh& mesh : meshes)
  {
    const IndentationResult got = indent(problem, mesh, folder.path(""));
    errors.push_back(got.force / problem.force() - 1.0);
    sizes.push_back(got.element_m);
    std::printf(
        "  %zu tets of %.3f contact radii: force %+.1f %%, %.1e of it sideways, contact "
        "radius %+.0f %%\n",
        got.tets, got.element_m / problem.contactRadius(), 100.0 * errors.back(),
        got.across / got.force, 100.0 * (got.radius_m / problem.contactRadius() - 1.0));
    // The block's cells are no mirror images of each other: less so the finer they are.
    EXPECT_LT(got.across, (&mesh == &meshes.back() ? 0.02 : 0.05) * got.force);
    EXPECT_NEAR(got.radius_m, problem.contactRadius(), sizes.back());
  }
  const std::size_t last = errors.size() - 1;
  const double order = std::log(errors[0] / errors[last]) / std::log(sizes[0] / sizes[last]);
  // To where an error of that order leads.
  const double ratio = std::pow(sizes[last - 1] / sizes[last], order);
  const double limit = errors[last] - (errors[last - 1] - errors[last]) / (ratio - 1.0);
  std::printf("  order %.2f, limit %+.1f %%\n", order, 100.0 * limit);
  EXPECT_GT(order, least_order);
  EXPECT_LT(std::abs(limit), most_in_the_limit);
  return errors[last];
}

TEST(Indentation, OfASphereLeadsToHertzsForce)
{
  expectForce(Indentation(), boxes({8, 12, 16}), 1.5, 0.05);
}

TEST(Indentation, OfAShallowSphereInACompressibleBlockToo)
{
  Indentation shallow;
  shallow.depth_m = 0.0001;
  shallow.poisson_ratio = 0.3;
  expectForce(shallow, boxes({8, 12, 16}), 1.2, 0.05);
}

TEST(Indentation, OfACone)
{
  Indentation cone;
  cone.shape = Indentation::Shape::cone;
  expectForce(cone, boxes({8, 12, 16}), 1.2, 0.08);
}

// Cells whose circles are those of what touches need a fraction of the nodes.
TEST(Indentation, IsWithinFivePercentWhereCellsFollowTheEdge)
{
  Indentation stiffer, punch, cone;
  stiffer.depth_m = 0.0005;
  stiffer.young_modulus_pa = 10000.0;
  stiffer.poisson_ratio = 0.49;
  punch.shape = Indentation::Shape::punch;
  punch.radius_m = 0.002;
  cone.shape = Indentation::Shape::cone;
  for (const Indentation& problem : {stiffer, punch, cone})
  {
    const test::ScratchFolder folder;
    const IndentationResult got =
        indent(problem, rings({12}, ElementKind::tet10)[0], folder.path(""));
    std::printf("  %zu nodes: force %+.1f %%, %.0f s\n", got.nodes,
                100.0 * (got.force / problem.force() - 1.0), got.seconds);
    EXPECT_NEAR(got.force, problem.force(), 0.05 * problem.force());
  }
  // With linear tets.
  EXPECT_LT(expectForce(punch, rings({8, 12, 24}, ElementKind::tet4), 1.5, 0.05), 0.1);
}

/** With quadratic tets. */
IndentationResult indentQuadratic(int cells, Response response, double stiffness)
{
  const test::ScratchFolder folder;
  IndentationMesh mesh;
  mesh.cells = cells;
  mesh.element = ElementKind::tet10;
  mesh.response = response;
  mesh.stiffness = stiffness;
  const IndentationResult got = indent(Indentation(), mesh, folder.path(""));
  std::printf("  %zu nodes, cells of %.3f contact radii: force %+.1f %%\n", got.nodes,
              got.element_m / Indentation().contactRadius(),
              100.0 * (got.force / Indentation().force() - 1.0));
  return got;
}

TEST(Indentation, OfASphereIsNearHertzsForceWithFewQuadraticTets)
{
  const double expected = Indentation().force();
  for (const Response response : {Response::segment, Response::point})
  {
    EXPECT_NEAR(indentQuadratic(5, response, 400.0).force, expected, 0.06 * expected);
  }
  const test::ScratchFolder folder;
  IndentationMesh linear;
  linear.cells = 10;  // about the same nodes
  EXPECT_GT(indent(Indentation(), linear, folder.path("")).force, 1.2 * expected);
}

// A block of six contact radii, whose cells need not grow much: 1536 to 12,288 quadratic tets.
TEST(Indentation, HasTheSameForceOnFourMeshes)
{
  Indentation sphere;
  sphere.block = 6.0;
  double least = 1e9, most = 0.0;
  for (const int cells : {4, 5, 6, 8})
  {
    const test::ScratchFolder folder;
    IndentationMesh mesh;
    mesh.cells = cells;
    mesh.growth = 2.8;
    mesh.element = ElementKind::tet10;
    mesh.stiffness = 100.0;
    const IndentationResult got = indent(sphere, mesh, folder.path(""));
    std::printf("  %zu nodes, cells of %.3f contact radii: %.6f N\n", got.nodes,
                got.element_m / sphere.contactRadius(), got.force);
    EXPECT_TRUE(got.converged);
    least = std::min(least, got.force);
    most = std::max(most, got.force);
  }
  EXPECT_LT(most, 1.05 * least);
}

TEST(Indentation, FormulasAgreeWithTheirPublishedValues)
{
  Indentation sphere, punch, cone;
  EXPECT_NEAR(sphere.force(), 0.018692, 1e-6);
  EXPECT_NEAR(sphere.contactRadius(), 0.0022361, 1e-7);
  punch.shape = Indentation::Shape::punch;
  punch.radius_m = 0.002;
  EXPECT_NEAR(punch.force(), 0.025078, 1e-6);
  cone.shape = Indentation::Shape::cone;
  EXPECT_NEAR(cone.force(), 0.0069132, 1e-7);
}

}  // namespace
}  // namespace soft_tissue::studies
