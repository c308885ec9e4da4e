#include "soft_tissue_sim/energy/mass_spring.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/mesh/mesh_io.h"
#include "soft_tissue_sim/mesh/topology.h"
#include "soft_tissue_sim/solver/newton.h"

namespace soft_tissue
{
namespace
{
constexpr double kYoung = 5000.0;    // Pa
constexpr double kDensity = 1000.0;  // kg/m^3

/** A bar along x, clamped at x = 0, of springs or of a law of strain. */
class Bar
{
 public:
  Bar(TetMesh mesh, double poisson_ratio) : mesh_(std::move(mesh))
  {
    const std::vector<TetStiffnessParameters> all(mesh_.tets.size(), {kYoung, poisson_ratio});
    springs_ = std::make_unique<MassSpring>(mesh_, all, 0);
    solid_ = std::make_unique<TetElasticity>(mesh_, MaterialModel::neo_hookean, all, 0);
    masses_.resize(mesh_.nodes.size(), 0.0);
    addLumpedMasses(mesh_, std::vector<double>(mesh_.tets.size(), kDensity), 0, masses_);
    Vec3 low = mesh_.nodes[0], high = low;
    for (const Vec3& p : mesh_.nodes)
    {
      length_ = std::max(length_, p.x());
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    axis_ = 0.5 * (low + high);
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i)
    {
      const double x = mesh_.nodes[i].x();
      (x < 1e-9 ? foot_ : x > length_ - 1e-9 ? head_ : free_).push_back(static_cast<Index>(i));
    }
  }

  EnergyTerm& springs() { return *springs_; }
  EnergyTerm& solid() { return *solid_; }

  /** Mean way down of the far end under a weight, m. */
  double sag(EnergyTerm& elasticity, double gravity)
  {
    Points x = mesh_.nodes;
    Gravity weight(masses_, Vec3(0.0, 0.0, -gravity));
    minimise({&elasticity, &weight}, foot_, x);
    double sum = 0.0;
    for (const Index i : head_)
    {
      sum += mesh_.nodes[i].z() - x[i].z();
    }
    return sum / static_cast<double>(head_.size());
  }

  struct Pull
  {
    double force;     ///< on the far end along the bar, N
    double narrower;  ///< share of its width that the bar lost in the middle
  };

  /** Both ends held, the far one where the bar is this many times as long. */
  Pull pull(EnergyTerm& elasticity, double stretch)
  {
    Points x = mesh_.nodes;
    for (Vec3& p : x)
    {
      p.x() *= stretch;
    }
    std::vector<Index> held = foot_;
    held.insert(held.end(), head_.begin(), head_.end());
    std::sort(held.begin(), held.end());
    minimise({&elasticity}, held, x);
    Points gradient(x.size(), Vec3::Zero());
    elasticity.addGradient(x, gradient);
    Pull result = {0.0, 0.0};
    for (const Index i : head_)
    {
      result.force += gradient[i].x();
    }
    double width = 0.0, rest = 0.0;  // mean distances from the axis
    for (const Index i : free_)
    {
      if (std::abs(mesh_.nodes[i].x() / length_ - 0.5) < 0.2)
      {
        rest += (mesh_.nodes[i] - axis_).tail<2>().norm();
        width += (x[i] - axis_).tail<2>().norm();
      }
    }
    result.narrower = 1.0 - width / rest;
    return result;
  }

 private:
  void minimise(const std::vector<EnergyTerm*>& terms, const std::vector<Index>& held, Points& x)
  {
    NewtonSolver newton(nodeNeighbours(static_cast<Index>(x.size()), mesh_.tets), held, makePcg());
    NewtonOptions options;
    options.tolerance = 1e-7;
    options.max_iterations = 100;
    std::vector<double> seconds(terms.size(), 0.0);
    EXPECT_TRUE(newton.minimise(terms, options, x, seconds).converged);
  }

  TetMesh mesh_;
  std::unique_ptr<MassSpring> springs_;
  std::unique_ptr<TetElasticity> solid_;
  std::vector<double> masses_;
  std::vector<Index> foot_, head_, free_;
  double length_ = 0.0;
  Vec3 axis_;
};

/** 100 x 20 x 20 mm in cells, or as a mesh generator made it. */
struct NamedMesh
{
  std::string name;
  TetMesh mesh;
};

std::vector<NamedMesh> meshes()
{
  const Vec3 size(0.1, 0.02, 0.02);
  std::vector<NamedMesh> all = {{"10 x 2 x 2 cells", makeBox({10, 2, 2}, size)},
                                {"20 x 4 x 4 cells", makeBox({20, 4, 4}, size)},
                                {"40 x 8 x 8 cells", makeBox({40, 8, 8}, size)}};
  if (const char* data = std::getenv("SOFT_TISSUE_DATA"))
  {
    for (const char* name : {"beam1k", "beam5k", "beam20k"})
    {
      all.push_back({name, loadTetMesh(std::string(data) + "/beams/" + name + ".msh", 1.0).mesh});
    }
  }
  return all;
}

/**
 * Stiffness of a box mesh that is strained alike everywhere, over Young's modulus, in strains xx,
 * yy, zz, 2 yz, 2 zx, 2 xy. Per volume a cube's six tets have springs along each axis with E/2
 * times the square of the strain along them, along a diagonal of each pair of faces with two thirds
 * of that, and along the body's diagonal with as much as along an axis.
 */
Eigen::Matrix<double, 6, 6> stiffnessOfCells()
{
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  const auto add = [&](const Vec3& along, double share) {
    const Vec3 n = along.normalized();
    Eigen::Matrix<double, 6, 1> strain;  // along n
    strain << n.x() * n.x(), n.y() * n.y(), n.z() * n.z(), n.y() * n.z(), n.z() * n.x(),
        n.x() * n.y();
    stiffness += share * strain * strain.transpose();
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    add(Vec3::Unit(axis), 1.0);
    add(Vec3::Ones() - Vec3::Unit(axis), 2.0 / 3.0);
  }
  add(Vec3::Ones(), 1.0);
  return stiffness;
}

TEST(MassSpring, HasTheStiffnessOfItsDirectionsWhereCellsAreStrainedAlike)
{
  const TetMesh mesh = makeBox({3, 4, 5}, {0.03, 0.04, 0.05});
  MassSpring springs(mesh, {mesh.tets.size(), {kYoung, 0.25}}, 0);
  const Eigen::Matrix<double, 6, 6> stiffness = stiffnessOfCells();
  const Vec3 strains[] = {Vec3(1.0, 0.0, 0.0), Vec3(0.3, -0.8, 0.5), Vec3(1.0, 1.0, 1.0)};
  for (const Vec3& normal : strains)
  {
    for (const double shear : {0.0, 0.7, -1.3})
    {
      Eigen::Matrix<double, 6, 1> strain;
      strain << normal, shear, -0.4 * shear, 0.6 * shear;
      strain *= 1e-5;
      Mat3 f = Mat3::Identity();
      f.diagonal() += strain.head<3>();
      f(1, 2) += strain[3];
      f(2, 0) += strain[4];
      f(0, 1) += strain[5];
      Points x;
      for (const Vec3& p : mesh.nodes)
      {
        x.push_back(f * p);
      }
      const double expected = 0.5 * 6e-5 * kYoung * strain.dot(stiffness * strain);
      EXPECT_NEAR(springs.value(x), expected, 1e-4 * expected);
    }
  }
  const Eigen::Matrix<double, 6, 6> gives = stiffness.inverse();
  std::printf("  along the cells %.4f E, narrower by %.4f of the strain\n", 1.0 / gives(0, 0),
              -gives(1, 0) / gives(0, 0));
}

TEST(MassSpring, IsAboutAsStiffAsASolidWithItsModuli)
{
  for (const double poisson_ratio : {0.25, 0.45})
  {
    for (NamedMesh& named : meshes())
    {
      Bar bar(named.mesh, poisson_ratio);
      const double sag = bar.sag(bar.springs(), 0.05) / bar.sag(bar.solid(), 0.05);
      const Bar::Pull thin = bar.pull(bar.springs(), 1.01),
                      thin_solid = bar.pull(bar.solid(), 1.01);
      const Bar::Pull far = bar.pull(bar.springs(), 1.5), far_solid = bar.pull(bar.solid(), 1.5);
      std::printf(
          "  nu %.2f, %s, springs over solid: sag %.3f, force at 1 %% %.3f, at 50 %% %.3f; "
          "narrower at 1 %% by %.3f %% and %.3f %%\n",
          poisson_ratio, named.name.c_str(), sag, thin.force / thin_solid.force,
          far.force / far_solid.force, 100.0 * thin.narrower, 100.0 * thin_solid.narrower);
      // Cells have edges in seven directions only.
      const bool irregular = named.name.find("beam") == 0;
      EXPECT_NEAR(thin.force / thin_solid.force, 1.0, irregular ? 0.06 : 0.25);
      EXPECT_NEAR(sag, 1.0, irregular ? 0.15 : 0.3);
      if (irregular)
      {
        EXPECT_NEAR(thin.narrower, thin_solid.narrower, 0.2 * thin_solid.narrower);
      }
    }
  }
}

}  // namespace
}  // namespace soft_tissue
