#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/energy/mass_terms.h"
#include "support/finite_difference.h"
#include "support/membranes.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 5000.0;
constexpr double kThick = 0.1;
constexpr double kScale = kYoung * kThick;  // N/m

const SheetPattern kPatterns[] = {SheetPattern::diagonal, SheetPattern::alternating,
                                  SheetPattern::crossed, SheetPattern::irregular};

Eigen::VectorXd flatDisplacement(const Points& points, const Mat3& h)
{
  Eigen::VectorXd u(3 * points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    u.segment<3>(3 * static_cast<Eigen::Index>(i)) = h * points[i];
  }
  return u;
}

TEST(MembraneStretch, HomogeneousSmallStrainsAreThoseOfPlaneStress)
{
  const TriMesh mesh = smallSheet();
  for (const double nu : {0.3, 0.0, -0.4, 0.5})
  {
    MembraneElasticity term = membrane(mesh, {kYoung, nu, kThick});
    const Eigen::MatrixXd stiffness =
        hessianOf(term, mesh.nodes, neighboursOf(mesh), Curvature::exact);
    Mat3 uniaxial = Mat3::Zero(), shear = Mat3::Zero(), turn = Mat3::Zero();
    uniaxial.diagonal() = Vec3(1.0, -nu, 0.0);  // stress E along x, none across
    shear(0, 1) = shear(1, 0) = 1.0;            // stress E / (1 + nu)
    turn << 0.0, -1.0, 2.0, 1.0, 0.0, -3.0, -2.0, 3.0, 0.0;
    Mat3 tension = Mat3::Zero(), shearing = Mat3::Zero();
    tension(0, 0) = kYoung;
    shearing(0, 1) = shearing(1, 0) = kYoung / (1.0 + nu);
    const std::pair<Mat3, Mat3> cases[] = {
        {uniaxial, tension}, {shear, shearing}, {turn, Mat3::Zero()}};
    for (const auto& [displacement, stress] : cases)
    {
      const Eigen::VectorXd force = stiffness * flatDisplacement(mesh.nodes, displacement);
      Eigen::VectorXd expected = Eigen::VectorXd::Zero(force.size());
      for (const Triangle& t : mesh.triangles)
      {
        for (int k = 0; k < 3; ++k)
        {
          // A times the shape gradient: half the opposite edge, turned inwards.
          const Vec3 edge = mesh.nodes[t[(k + 2) % 3]] - mesh.nodes[t[(k + 1) % 3]];
          expected.segment<3>(3 * t[k]) += 0.5 * kThick * stress * Vec3::UnitZ().cross(edge);
        }
      }
      EXPECT_LT((force - expected).norm(), 1e-13 * kScale * std::sqrt(force.size())) << nu;
    }
  }
}

/** One triangle with rest edges on the unit axes: nodes 1 and 2 are the columns of F. */
TEST(MembraneStretch, ProjectionIsThePositivePartOfOneTriangle)
{
  const TriMesh one = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  MembraneElasticity term = membrane(one, {kYoung, 0.3, kThick});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0.0, 2.0);
  for (int k = 0; k < 200; ++k)
  {
    const double long_one = uniform(random), thin = k % 4 == 0 ? 1e-3 : uniform(random);
    const Points x =
        moved(one.nodes, stretched(random, long_one, k % 7 == 0 ? long_one : thin, 1.0));
    const Eigen::MatrixXd exact = hessianOf(term, x, neighboursOf(one), Curvature::exact);
    const Eigen::MatrixXd positive = hessianOf(term, x, neighboursOf(one));
    EXPECT_LT((exact - differenceHessian(term, x, 1e-4)).norm(), 1e-7 * (kScale + exact.norm()));
    EXPECT_LT((positive.bottomRightCorner(6, 6) - projected(exact.bottomRightCorner(6, 6))).norm(),
              1e-11 * (kScale + exact.norm()));
  }
}

TEST(MembraneStretch, UniaxialStretchIsTheClosedForm)
{
  const TriMesh mesh = smallSheet();
  MembraneElasticity term = membrane(mesh, {kYoung, 0.3, kThick});
  const double mu = kYoung / 2.6, kappa = kYoung / 1.4;
  for (const double s : {0.3, 0.7, 1.0, 1.5, 4.0})
  {
    const Points x = moved(mesh.nodes, Vec3(s, 1.1, 1.0).asDiagonal());
    const double density =
        0.5 * mu * (s - 1.1) * (s - 1.1) + 0.5 * kappa * (1.1 * s - 1.0) * (1.1 * s - 1.0);
    EXPECT_NEAR(term.value(x), 9.0 * kThick * density, 1e-12 * kScale * (1.0 + density / kYoung));
    EXPECT_NEAR(term.smallestAreaRatio(x), 1.1 * s, 1e-13 * s);
  }
}

/** Energy of w = 1/2 x^T K x over that of a Kirchhoff plate with the lateral ratio -|nu|. */
double bendingRatio(const TriMesh& mesh, double nu, const Mat3& k)
{
  MembraneElasticity term = membrane(mesh, {kYoung, nu, kThick});
  constexpr double kSlight = 1e-4;
  Points x = mesh.nodes;
  double area = 0.0;
  for (Vec3& p : x)
  {
    p.z() = 0.5 * kSlight * p.dot(k * p);
  }
  for (const Triangle& t : mesh.triangles)
  {
    area += areaOf(mesh, t);
  }
  const double d = kYoung * kThick * kThick * kThick / (12.0 * (1.0 - nu * nu));
  const double determinant = k(0, 0) * k(1, 1) - k(0, 1) * k(0, 1);
  return term.value(x) / (0.5 * kSlight * kSlight * area * d *
                          (k.trace() * k.trace() - 2.0 * (1.0 + std::abs(nu)) * determinant));
}

TEST(MembraneBending, ConstantCurvaturesHaveThePlatesEnergy)
{
  Mat3 along = Mat3::Zero(), across = Mat3::Zero(), twist = Mat3::Zero(), bowl = Mat3::Zero();
  along(0, 0) = across(1, 1) = bowl(0, 0) = bowl(1, 1) = 1.0;
  twist(0, 1) = twist(1, 0) = 1.0;
  for (const SheetPattern pattern : kPatterns)
  {
    std::printf("  pattern %d, energy over a plate's:", static_cast<int>(pattern));
    for (const double nu : {0.0, 0.3, 0.5})
    {
      for (const Mat3& k : {along, across, twist, bowl})
      {
        // Along the rim nothing bends: a share of the area that halves with the cells.
        for (const int cells : {12, 24})
        {
          const TriMesh mesh = makeSheet({cells, cells}, {1.2, 1.2}, pattern);
          const double ratio = bendingRatio(mesh, nu, k);
          std::printf(cells == 12 ? " %.3f" : " (%.3f)", ratio);
          EXPECT_NEAR(ratio, 1.0, 1.4 / cells);
        }
      }
    }
    std::printf("\n");
  }
}

TEST(MembraneBending, EnergyGrowsWithTheSquareOfTheAngle)
{
  const TriMesh hinge = {{{0, 0, 0}, {1, 0, 0}, {0.3, 1, 0}, {0.6, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  MembraneElasticity term = membrane(hinge, {kYoung, 0.3, kThick});
  const auto energy = [&](double angle) {
    Points x = hinge.nodes;
    x[2] = Vec3(0.3, std::cos(angle), std::sin(angle));
    return term.value(x);
  };
  const double unit = energy(1.0);
  EXPECT_GT(unit, 0.0);
  for (const double angle : {-3.14, -2.0, -0.5, 0.01, 0.4, 0.8, 1.5, 1.6, 2.3, 2.4, 3.0, 3.141592})
  {
    EXPECT_NEAR(energy(angle), unit * angle * angle, 1e-13 * kScale) << angle;
  }
}

TEST(Membrane, DoesNotSeeHowTrianglesAreWound)
{
  const TriMesh mesh = smallSheet();
  TriMesh turned = mesh;
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
  {
    std::swap(turned.triangles[t][1], turned.triangles[t][2]);
  }
  MembraneElasticity term = membrane(mesh, {kYoung, 0.3, kThick});
  MembraneElasticity other = membrane(turned, {kYoung, 0.3, kThick});
  for (const NamedShape& shape : sheetShapes())
  {
    const double value = term.value(shape.x);
    EXPECT_NEAR(other.value(shape.x), value, 1e-9 * (kScale + value)) << shape.name;
  }
}

TEST(Membrane, BendsAtNoEdgeOfThreeTriangles)
{
  const TriMesh book = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}},
                        {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  MembraneElasticity term = membrane(book, {kYoung, 0.3, kThick});
  Points x = book.nodes;
  x[2] = Vec3(0.0, std::cos(0.5), std::sin(0.5));  // leafed through: no triangle stretches
  EXPECT_NEAR(term.value(x), 0.0, 1e-13 * kScale);
  EXPECT_LT(
      (hessianOf(term, x, neighboursOf(book), Curvature::exact) - differenceHessian(term, x, 1e-4))
          .norm(),
      1e-7 * kScale);
}

TEST(Membrane, OfFourTrianglesThatCloseHasItsHessian)
{
  // What lies across any two edges of a triangle is one node.
  const TriMesh closed = unitTetSurface();
  MembraneElasticity term = membrane(closed, {kYoung, 0.3, kThick});
  EXPECT_NEAR(term.value(closed.nodes), 0.0, 1e-13 * kScale);
  const Points x = shaken(closed.nodes, 0.2, 3);
  const Eigen::MatrixXd hessian = hessianOf(term, x, neighboursOf(closed), Curvature::exact);
  EXPECT_LT((hessian - differenceHessian(term, x, 1e-4)).norm(), 1e-7 * hessian.norm());
}

TEST(Membrane, StandsAmongOtherBodies)
{
  const TriMesh mesh = smallSheet();
  const std::vector<MembraneParameters> parameters(mesh.triangles.size(), {kYoung, 0.3, kThick});
  MembraneElasticity term(mesh, parameters, 0), behind(mesh, parameters, 4);
  const Points x = shaken(mesh.nodes, 0.2, 6);
  Points all(4, Vec3(7.0, 8.0, 9.0));
  all.insert(all.end(), x.begin(), x.end());
  EXPECT_EQ(behind.value(all), term.value(x));
  const Eigen::VectorXd gradient = gradientOf(behind, all);
  EXPECT_TRUE(gradient.head(12).isZero(0.0));
  EXPECT_TRUE(gradient.tail(gradient.size() - 12) == gradientOf(term, x));
}

TEST(Membrane, WeighsWhatItsTrianglesDo)
{
  const TriMesh mesh = smallSheet();
  std::vector<double> masses(mesh.nodes.size() + 2, 0.0), densities;
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
  {
    densities.push_back(1.0 + static_cast<double>(t));
    sum += densities[t] * areaOf(mesh, mesh.triangles[t]);
  }
  addLumpedMasses(mesh, densities, 2, masses);
  double all = 0.0;
  for (const double mass : masses)
  {
    all += mass;
  }
  EXPECT_NEAR(all, sum, 1e-12 * sum);
  EXPECT_EQ(masses[0] + masses[1], 0.0);
  EXPECT_NEAR(
      masses[2],
      densities[0] * areaOf(mesh, mesh.triangles[0]) / 3.0 +
          (mesh.triangles[1][0] == 0 ? densities[1] * areaOf(mesh, mesh.triangles[1]) / 3.0 : 0.0),
      1e-12);
}

void expectRefused(const TriMesh& mesh, const MembraneParameters& parameters,
                   const std::string& message)
{
  try
  {
    std::vector<MembraneParameters> all(mesh.triangles.size(), {kYoung, 0.3, kThick});
    all[1] = parameters;
    MembraneElasticity term(mesh, all, 0);
    FAIL() << "accepted: " << message;
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
  }
}

TEST(Membrane, RefusesWhatHasNoStiffness)
{
  const TriMesh mesh = smallSheet();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1.0, std::nan(""), inf})
  {
    expectRefused(mesh, {bad, 0.3, kThick}, "triangle 1 has young_modulus");
    expectRefused(mesh, {kYoung, 0.3, bad}, "triangle 1 has thickness");
  }
  for (const double bad : {-1.0, 0.51, std::nan("")})
  {
    expectRefused(mesh, {kYoung, bad, kThick}, "triangle 1 has poisson_ratio");
  }
  TriMesh line = mesh;
  const Triangle& t = mesh.triangles[1];
  line.nodes[t[2]] = 0.5 * (line.nodes[t[0]] + line.nodes[t[1]]);
  expectRefused(line, {kYoung, 0.3, kThick}, "triangle 1 has rest area");
}

}  // namespace
}  // namespace soft_tissue
