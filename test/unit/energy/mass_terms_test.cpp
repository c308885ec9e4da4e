#include "soft_tissue_sim/energy/mass_terms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "soft_tissue_sim/mesh/generate.h"

namespace soft_tissue
{
namespace
{
/** A box of 3 x 2 x 1 m whose inner nodes don't stand in rows. */
TetMesh unevenBox()
{
  TetMesh mesh = makeBox({3, 3, 3}, {3.0, 2.0, 1.0});
  for (Vec3& p : mesh.nodes)
  {
    const double bump = p.x() * (3.0 - p.x()) * p.y() * (2.0 - p.y()) * p.z() * (1.0 - p.z());
    p += bump * Vec3(0.2, -0.15, 0.1);
  }
  return mesh;
}

double factorial(int n)
{
  return std::tgamma(n + 1.0);
}

/** Mean of L_0^a L_1^b over a tet. */
double meanOf(int a, int b)
{
  return 6.0 * factorial(a) * factorial(b) / factorial(a + b + 3);
}

TEST(QuadraticMasses, AreTheScaledDiagonalOfTheConsistentMasses)
{
  const double vertex = 4.0 * meanOf(4, 0) - 4.0 * meanOf(3, 0) + meanOf(2, 0);  // (2 L L - L)^2
  const double edge = 16.0 * meanOf(2, 2);                                       // (4 L L)^2
  const double all = 4.0 * vertex + 6.0 * edge;
  const QuadraticTetMesh mesh =
      withEdgeNodes({{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}}, {{0, 1, 2, 3}}, {0}});
  std::vector<double> masses(12, 0.0);
  addLumpedMasses(mesh, {10.0}, 2, masses);
  for (int k = 0; k < 10; ++k)
  {
    EXPECT_NEAR(masses[2 + k], 10.0 * (k < 4 ? vertex : edge) / all, 1e-13);
  }
  EXPECT_EQ(masses[0] + masses[1], 0.0);
}

TEST(QuadraticMasses, HaveMassAndCentreOfTheBody)
{
  const QuadraticTetMesh mesh = withEdgeNodes(unevenBox());
  const std::vector<double> densities(mesh.elements.size(), 1000.0);
  std::vector<double> masses(mesh.nodes.size(), 0.0);
  addLumpedMasses(mesh, densities, 0, masses);
  double mass = 0.0;
  Vec3 first = Vec3::Zero();
  for (std::size_t i = 0; i < masses.size(); ++i)
  {
    EXPECT_GT(masses[i], 0.0);
    mass += masses[i];
    first += masses[i] * mesh.nodes[i];
  }
  EXPECT_NEAR(mass, 6000.0, 1e-9);
  EXPECT_LT((first / mass - Vec3(1.5, 1.0, 0.5)).norm(), 1e-12);
}

TEST(QuadraticMasses, LoadsDoTheWorkOfAUniformForceInEveryQuadraticDisplacement)
{
  const QuadraticTetMesh mesh = withEdgeNodes(unevenBox());
  std::vector<double> loads(mesh.nodes.size(), 0.0);
  addLoadMasses(mesh, std::vector<double>(mesh.elements.size(), 1.0), 0, loads);
  // The integral of x^a y^b z^c over the box, for all powers of a sum of at most two.
  for (int a = 0; a <= 2; ++a)
  {
    for (int b = 0; a + b <= 2; ++b)
    {
      for (int c = 0; a + b + c <= 2; ++c)
      {
        double work = 0.0;
        for (std::size_t i = 0; i < loads.size(); ++i)
        {
          const Vec3& p = mesh.nodes[i];
          work += loads[i] * std::pow(p.x(), a) * std::pow(p.y(), b) * std::pow(p.z(), c);
        }
        const double expected =
            std::pow(3.0, a + 1) / (a + 1) * std::pow(2.0, b + 1) / (b + 1) / (c + 1);
        EXPECT_NEAR(work, expected, 1e-12 * expected) << a << b << c;
      }
    }
  }
}

}  // namespace
}  // namespace soft_tissue
