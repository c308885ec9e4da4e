#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/solver/newton.h"
#include "support/elastica.h"
#include "support/finite_difference.h"
#include "support/membranes.h"
#include "support/pulled_block.h"

namespace soft_tissue
{
namespace
{
using namespace test;

constexpr double kYoung = 1e6;
constexpr double kThick = 0.001;

double bendingStiffness(double nu)
{
  return kYoung * kThick * kThick * kThick / (12.0 * (1.0 - nu * nu));
}

const char* name(SheetPattern pattern)
{
  constexpr const char* kNames[] = {"diagonal", "alternating", "crossed", "irregular"};
  return kNames[static_cast<int>(pattern)];
}

/** Nodes at rest under dead loads. */
Points bent(const TriMesh& mesh, double nu, const std::vector<Index>& fixed, const Points& forces)
{
  MembraneElasticity elasticity = membrane(mesh, {kYoung, nu, kThick});
  NodalLoads loads(forces);
  NewtonSolver newton(neighboursOf(mesh), fixed, makeCholesky());
  Points x = mesh.nodes;
  const NewtonReport report = minimise(newton, {&elasticity, &loads}, optionsOf(1e-5, 100), x);
  EXPECT_TRUE(report.converged) << "residual " << report.residual;
  return x;
}

/** A sheet on which lines of nodes are straight at a cell from its ends, as an edge held there has
 * to be. */
TriMesh sheet(const std::array<int, 2>& cells, const std::array<double, 2>& size,
              SheetPattern pattern)
{
  TriMesh mesh = makeSheet(cells, size, pattern);
  for (int j = 0; j <= cells[1]; ++j)
  {
    for (int i = 0; i <= cells[0]; ++i)
    {
      Vec3& p = mesh.nodes[j * (cells[0] + 1) + i];
      p.x() = i == 1 || i == cells[0] - 1 ? size[0] * i / cells[0] : p.x();
      p.y() = j == 1 || j == cells[1] - 1 ? size[1] * j / cells[1] : p.y();
    }
  }
  return mesh;
}

/**
 * Deflection of the centre over q a^4 / D of a square plate of side a under uniform load, supported
 * or clamped all round. An edge is clamped by holding the nodes half a cell to both of its sides.
 */
double plateDeflection(SheetPattern pattern, int cells, bool clamped)
{
  constexpr double kSide = 0.1, kNu = 0.3;
  const double cell = kSide / (clamped ? cells - 1 : cells);
  const double margin = clamped ? 0.5 * cell : 0.0;
  const double whole = kSide + 2.0 * margin;
  const TriMesh mesh = sheet({cells, cells}, {whole, whole}, pattern);
  const double d = bendingStiffness(kNu);
  const double load = kThick / 300.0 * d / (0.004 * std::pow(kSide, 4));  // far below a thickness
  Points forces(mesh.nodes.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles)
  {
    for (const Index node : t)
    {
      forces[node].z() += load * areaOf(mesh, t) / 3.0;
    }
  }
  std::vector<Index> fixed;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    const Vec3& p = mesh.nodes[i];
    const double low = std::min(p.x(), p.y()), high = std::max(p.x(), p.y());
    if (low < 2.0 * margin + 1e-6 * cell || high > whole - 2.0 * margin - 1e-6 * cell)
    {
      fixed.push_back(static_cast<Index>(i));
    }
  }
  double highest = 0.0;
  for (const Vec3& p : bent(mesh, kNu, fixed, forces))
  {
    highest = std::max(highest, p.z());
  }
  return highest * d / (load * std::pow(kSide, 4));
}

struct PlateCase
{
  bool clamped;
  double exact;     ///< [Timoshenko1959] tables 8 and 35
  double error[3];  ///< of 8, 16 and 32 cells a side
};

class EveryPattern : public ::testing::TestWithParam<SheetPattern>
{};

INSTANTIATE_TEST_SUITE_P(All, EveryPattern,
                         ::testing::Values(SheetPattern::diagonal, SheetPattern::alternating,
                                           SheetPattern::crossed, SheetPattern::irregular));

TEST_P(EveryPattern, SquarePlatesSagAsKirchhoffs)
{
  const PlateCase cases[] = {{false, 0.00406, {0.04, 0.01, 0.006}},
                             {true, 0.00126, {0.18, 0.07, 0.03}}};
  for (const PlateCase& plate : cases)
  {
    for (int mesh = 0; mesh < 3; ++mesh)
    {
      const int cells = 8 << mesh;
      const double found = plateDeflection(GetParam(), cells, plate.clamped);
      std::printf("  %s, %s, %2d cells: %.5f q a^4/D (%+.2f %%)\n", name(GetParam()),
                  plate.clamped ? "clamped" : "supported", cells, found,
                  100.0 * (found / plate.exact - 1.0));
      EXPECT_NEAR(found, plate.exact, plate.error[mesh] * plate.exact);
    }
  }
}

/** Mean way of a strip's end, over its length, under a force of alpha E I / L^2 across. */
BeamTip stripTip(SheetPattern pattern, int cells, double nu, double alpha)
{
  constexpr double kLength = 0.1, kSlender = 5.0, kWidth = kLength / kSlender;
  const double cell = kWidth / cells;
  const int along = static_cast<int>(kSlender) * cells;
  // Clamped midway between its first two lines of nodes.
  const double whole = kLength * (along + 0.5) / along + 0.5 * cell;
  TriMesh mesh = sheet({along + 1, cells}, {whole, kWidth}, pattern);
  const double clamp = 0.5 * whole / (along + 1), length = whole - clamp;
  const double stiffness = bendingStiffness(nu) * (1.0 - nu * nu) * kWidth;
  const double force = alpha * stiffness / (length * length);
  std::vector<Index> fixed;
  std::vector<double> share(mesh.nodes.size(), 0.0);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
  {
    mesh.nodes[i].x() -= clamp;
    const Vec3& p = mesh.nodes[i];
    if (p.x() < 1.01 * clamp)
    {
      fixed.push_back(static_cast<Index>(i));
    }
    if (p.x() > length - 1e-6 * cell)
    {
      const bool corner = p.y() < 1e-6 * cell || p.y() > kWidth - 1e-6 * cell;
      share[i] = (corner ? 0.5 : 1.0) / cells;
    }
  }
  Points forces;
  for (const double part : share)
  {
    forces.emplace_back(0.0, 0.0, -part * force);
  }
  const Points x = bent(mesh, nu, fixed, forces);
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    mean += share[i] * (x[i] - mesh.nodes[i]);
  }
  return {-mean.x() / length, -mean.z() / length, 0.0};
}

TEST_P(EveryPattern, StripsBendAsBeams)
{
  for (const double nu : {0.0, 0.3, 0.5})
  {
    double last = 0.0;
    for (const int cells : {2, 4, 8})
    {
      constexpr double kSmall = 0.003;
      last = stripTip(GetParam(), cells, nu, kSmall).down / (kSmall / 3.0) - 1.0;
      std::printf("  %s, nu %.1f, %d cells across: tip %+.2f %%\n", name(GetParam()), nu, cells,
                  100.0 * last);
    }
    // Where it is clamped the strip can't curve across: the wider, the stiffer.
    EXPECT_NEAR(last, 0.0, 0.02 + 0.4 * nu * nu);
  }
}

TEST_P(EveryPattern, StripsBendAsTheElastica)
{
  for (const double alpha : {1.0, 4.0})
  {
    const BeamTip exact = Rod({alpha}).tip();
    const BeamTip found = stripTip(GetParam(), 8, 0.0, alpha);
    std::printf("  %s, alpha %.0f: w/L %.5f (%+.2f %%), u/L %.5f (%+.2f %%)\n", name(GetParam()),
                alpha, found.down, 100.0 * (found.down / exact.down - 1.0), found.along,
                100.0 * (found.along / exact.along - 1.0));
    EXPECT_NEAR(found.down, exact.down, 0.015 * exact.down);
    EXPECT_NEAR(found.along, exact.along, 0.03 * exact.along);
  }
}

/** A sheet whose rim is at the stretches of uniaxial tension: inside all nodes follow, and only its
 * ends pull. */
TEST_P(EveryPattern, UniaxialTensionIsTheClosedForm)
{
  constexpr double kNu = 0.3, kSide = 0.1;
  const double mu = kYoung / (2.0 * (1.0 + kNu)), kappa = kYoung / (2.0 * (1.0 - kNu));
  const TriMesh mesh = makeSheet({8, 8}, {kSide, kSide}, GetParam());
  for (const double s : {1.05, 1.5, 3.0})
  {
    const double across = (mu + kappa) * s / (mu + kappa * s * s);
    const double stress = mu * (s - across) + kappa * (s * across - 1.0) * across;
    const Points exact = moved(mesh.nodes, Vec3(s, across, 1.0).asDiagonal());
    Points x = exact;
    std::vector<Index> fixed;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      const double low = mesh.nodes[i].head<2>().minCoeff();
      const double high = mesh.nodes[i].head<2>().maxCoeff();
      if (low < 1e-9 || high > kSide - 1e-9)
      {
        fixed.push_back(static_cast<Index>(i));
      }
      else
      {
        x[i] = mesh.nodes[i] + Vec3(0.1, 0.05, 0.0) * kSide / 8.0;
      }
    }
    MembraneElasticity elasticity = membrane(mesh, {kYoung, kNu, kThick});
    NewtonSolver newton(neighboursOf(mesh), fixed, makeCholesky());
    const NewtonReport report = minimise(newton, {&elasticity}, optionsOf(1e-11, 50), x);
    EXPECT_TRUE(report.converged) << "residual " << report.residual;
    Points gradient(x.size(), Vec3::Zero());
    elasticity.addGradient(x, gradient);
    double pull = 0.0, side = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      EXPECT_LT((x[i] - exact[i]).norm(), 1e-9 * kSide);
      pull += mesh.nodes[i].x() > kSide - 1e-9 ? gradient[i].x() : 0.0;
      side = std::max(side, std::abs(gradient[i].y()));
    }
    EXPECT_NEAR(pull, kSide * kThick * stress, 1e-9 * kSide * kThick * stress);
    EXPECT_LT(side, 1e-9 * kSide * kThick * stress);
  }
}

}  // namespace
}  // namespace soft_tissue
