#pragma once

#include <map>
#include <memory>
#include <vector>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/quadratic_tet_elasticity.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/mesh/generate.h"
#include "soft_tissue_sim/scene/config.h"
#include "soft_tissue_sim/solver/newton.h"
#include "support/elastica.h"

namespace soft_tissue::test
{
/** A slender beam with a square section, clamped at x = 0, nu = 0; gravity is -z. */
class Cantilever
{
 public:
  static constexpr double kLength = 0.2;      // m
  static constexpr double kSlender = 20.0;    // length over thickness, unless asked for
  static constexpr double kYoung = 1e4;       // Pa
  static constexpr double kDensity = 1000.0;  // kg/m^3

  /** Cubes of a `cells`-th of the thickness along and across the beam, one over its width: what
   * does not change along y does not need more. */
  Cantilever(MaterialModel model, int cells, ElementKind kind = ElementKind::tet4)
      : Cantilever(model, {static_cast<int>(kSlender) * cells, 1, cells}, kSlender, kind)
  {}

  /** Cells along the beam, over its width and over its thickness. */
  Cantilever(MaterialModel model, const std::array<int, 3>& cells, double slender, ElementKind kind)
      : thick_(kLength / slender),
        bending_(kYoung * thick_ * thick_ * thick_ * thick_ / 12.0),
        cells_(cells),
        rest_(makeBox(cells_, {kLength, thick_, thick_}))
  {
    const TetMesh box = rest_;
    const std::vector<TetStiffnessParameters> stiffness(box.tets.size(), {kYoung, 0.0});
    const std::vector<double> densities(box.tets.size(), kDensity);
    Adjacency neighbours = nodeNeighbours(static_cast<Index>(box.nodes.size()), box.tets);
    std::map<Edge, Index> middles;
    if (kind == ElementKind::tet4)
    {
      elasticity_ = std::make_unique<TetElasticity>(box, model, stiffness, 0);
      masses_.resize(box.nodes.size(), 0.0);
      addLumpedMasses(box, densities, 0, masses_);
    }
    else
    {
      const QuadraticTetMesh quadratic = withEdgeNodes(box);
      rest_ = subdivided(quadratic);
      neighbours = nodeNeighbours(static_cast<Index>(rest_.nodes.size()), quadratic.elements);
      elasticity_ = std::make_unique<QuadraticTetElasticity>(quadratic, model, stiffness, 0);
      masses_.resize(rest_.nodes.size(), 0.0);
      addLoadMasses(quadratic, densities, 0, masses_);
      for (const QuadraticTet& element : quadratic.elements)
      {
        for (int e = 0; e < 6; ++e)
        {
          const Index a = element[kTetEdges[e][0]], b = element[kTetEdges[e][1]];
          middles[{std::min(a, b), std::max(a, b)}] = element[4 + e];
        }
      }
    }
    elements_ = box.tets.size();
    const auto count = static_cast<Index>(rest_.nodes.size());
    end_share_.resize(rest_.nodes.size(), 0.0);
    std::vector<Index> clamped;
    for (Index i = 0; i < count; ++i)
    {
      if (rest_.nodes[i].x() == 0.0)
      {
        clamped.push_back(i);
      }
    }
    for (Triangle t : extractBoundary(count, box.tets).triangles)
    {
      const Vec3& a = rest_.nodes[t[0]];
      const Vec3 area = 0.5 * (rest_.nodes[t[1]] - a).cross(rest_.nodes[t[2]] - a);
      if (area.x() > 0.9 * area.norm())
      {
        if (kind == ElementKind::tet10)  // a uniform pull acts at the middles of the sides alone
        {
          const Triangle corners = t;
          for (int k = 0; k < 3; ++k)
          {
            const Index b = corners[k], c = corners[(k + 1) % 3];
            t[k] = middles.at({std::min(b, c), std::max(b, c)});
          }
        }
        for (const Index node : t)
        {
          end_share_[node] += area.norm() / (3.0 * thick_ * thick_);
        }
      }
    }
    newton_ = std::make_unique<NewtonSolver>(neighbours, clamped, makeCholesky());
  }

  const TetMesh& rest() const { return rest_; }
  std::size_t elements() const { return elements_; }

  /** The beam at rest under these loads (stretch and shear are its own); x: start and solution. */
  NewtonReport bend(const BeamLoad& load, Points& x)
  {
    const double tip_force = load.tip * bending_ / (kLength * kLength);
    Points forces;
    for (const double share : end_share_)
    {
      forces.emplace_back(0.0, 0.0, -share * tip_force);
    }
    NodalLoads pull(forces);
    const double weight = load.weight * bending_ / (kLength * kLength * kLength);
    Gravity gravity(masses_, {0.0, 0.0, -weight / (kDensity * thick_ * thick_)});
    const std::vector<EnergyTerm*> terms = {elasticity_.get(), &pull, &gravity};
    NewtonOptions options;
    options.tolerance = 1e-7;
    options.max_iterations = 200;
    std::vector<double> seconds(terms.size(), 0.0);
    return newton_->minimise(terms, options, x, seconds);
  }

  /** Mean displacement of the end face, in units of the length. */
  BeamTip tip(const Points& x) const
  {
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      mean += end_share_[i] * (x[i] - rest_.nodes[i]);
    }
    return {-mean.x() / kLength, -mean.z() / kLength, 0.0};
  }

  /** The same shape on a mesh of half the cell size: new nodes midway between old ones. */
  static Points refined(const Cantilever& coarse, const Points& x, const Cantilever& fine)
  {
    const auto place = [](int at, int side) { return at % 2 == 0 ? at / 2 : at / 2 + side; };
    Points finer;
    for (int k = 0; k <= fine.cells_[2]; ++k)
    {
      for (int j = 0; j <= fine.cells_[1]; ++j)
      {
        for (int i = 0; i <= fine.cells_[0]; ++i)
        {
          Vec3 sum = Vec3::Zero();
          for (int corner = 0; corner < 4; ++corner)
          {
            sum += x[coarse.node(place(i, corner % 2), j, place(k, corner / 2))];
          }
          finer.push_back(0.25 * sum);
        }
      }
    }
    return finer;
  }

 private:
  Index node(int i, int j, int k) const
  {
    return static_cast<Index>((k * (cells_[1] + 1) + j) * (cells_[0] + 1) + i);
  }

  double thick_;    ///< m
  double bending_;  ///< EI
  std::array<int, 3> cells_;
  TetMesh rest_;  ///< quadratic tets cut into linear ones
  std::size_t elements_ = 0;
  std::vector<double> masses_;     ///< what gravity pulls at
  std::vector<double> end_share_;  ///< of the end face's area, per node
  std::unique_ptr<Elasticity> elasticity_;
  std::unique_ptr<NewtonSolver> newton_;
};

}  // namespace soft_tissue::test
