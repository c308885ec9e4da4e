#pragma once

#include <vector>

#include "soft_tissue_sim/energy/term.h"
#include "soft_tissue_sim/mesh/quadratic_tets.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue
{
/** Adds a quarter of each tet's mass to its nodes: masses[first_node + i] += ..., kg. densities:
 * one per tet, kg/m^3. */
void addLumpedMasses(const TetMesh& rest, const std::vector<double>& densities, Index first_node,
                     std::vector<double>& masses);

/** Adds a third of each triangle's mass to its nodes. surface_densities: density times thickness,
 * one per triangle, kg/m^2. */
void addLumpedMasses(const TriMesh& rest, const std::vector<double>& surface_densities,
                     Index first_node, std::vector<double>& masses);

/**
 * Adds each element's mass to its nodes as the diagonal of its consistent mass matrix has it: 1/36
 * to each vertex, 4/27 to each edge. Source: [Hinton1976]
 */
void addLumpedMasses(const QuadraticTetMesh& rest, const std::vector<double>& densities,
                     Index first_node, std::vector<double>& masses);

/** Adds the mass times the mean of each node's shape function, what a uniform force on it acts
 * with: -1/20 of the element's to each vertex, 1/5 to each edge. */
void addLoadMasses(const QuadraticTetMesh& rest, const std::vector<double>& densities,
                   Index first_node, std::vector<double>& masses);

/**
 * How a step ends: x = x' + s v and v = v' + s a, where s is the effective step, a the acceleration
 * at its end, x' = x0 + c (x0 - x1) and v' = v0 + c (v0 - v1); 0 is where the step starts, 1 where
 * the last one did, c the share of its change that is carried on.
 */
struct StepFormula
{
  double effective_s = 0.0;
  double carried = 0.0;

  /** First order, needs nothing of the last step. */
  static StepFormula implicitEuler(double step_s) { return {step_s, 0.0}; }
  /** Second order, for steps of any ratio; both have the same formula for x and v.
   * Source: [Hairer1993] section III.5 */
  static StepFormula bdf2(double step_s, double last_step_s);
};

/** Positions and velocities of all nodes where a step starts and where the last one did, N x 3
 * each, m and m/s. */
struct StepStart
{
  const Points &x, &v, &x_last, &v_last;

  /** x' and v' of StepFormula. */
  Vec3 position(std::size_t i, const StepFormula& formula) const
  {
    return x[i] + formula.carried * (x[i] - x_last[i]);
  }
  Vec3 velocity(std::size_t i, const StepFormula& formula) const
  {
    return v[i] + formula.carried * (v[i] - v_last[i]);
  }
};

/** Nodes begin to end - 1. */
struct NodeRange
{
  Index begin = 0, end = 0;
};

/** 1/2 sum k |x - p|^2: each node is drawn to a place of its own. */
class NodalSprings : public EnergyTerm
{
 public:
  /** Counts these nodes alone, by ascending ranges; at first all. */
  void setNodes(const std::vector<NodeRange>& nodes) { nodes_ = nodes; }

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  double valueAndGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

 protected:
  explicit NodalSprings(std::size_t count)
      : places_(count, Vec3::Zero()), stiffness_(count, 0.0), nodes_{{0, static_cast<Index>(count)}}
  {}

  Points places_;                  ///< p, m
  std::vector<double> stiffness_;  ///< k, N/m

 private:
  std::vector<NodeRange> nodes_;
};

/** 1/(2 s^2) |x - target|^2 in the lumped mass, target = x' + s v': what makes a step of
 * StepFormula a minimisation. */
class Inertia : public NodalSprings
{
 public:
  /** @param masses N, kg; must outlive the term */
  explicit Inertia(const std::vector<double>& masses) : NodalSprings(masses.size()), masses_(masses)
  {}

  /** Begins a step of nodes first to first + count - 1.
   * @return whether their second derivative is another than in the last step */
  bool beginStep(Index first, Index count, const StepStart& start, const StepFormula& formula);

  const Points& target() const { return places_; }

 private:
  const std::vector<double>& masses_;
};

/** 1/(2 s) sum c |x - x'|^2: a force -c v against each node's velocity. */
class Drag : public NodalSprings
{
 public:
  /** @param coefficients N, kg/s; must outlive the term */
  explicit Drag(const std::vector<double>& coefficients)
      : NodalSprings(coefficients.size()), coefficients_(coefficients)
  {}

  /** Begins a step of nodes first to first + count - 1. */
  void beginStep(Index first, Index count, const StepStart& start, const StepFormula& formula);

 private:
  const std::vector<double>& coefficients_;
};

/** -sum m g . x. */
class Gravity : public EnergyTerm
{
 public:
  /** @param masses N, kg, lumped or addLoadMasses(); must outlive the term
   * @param acceleration m/s^2, world */
  Gravity(const std::vector<double>& masses, const Vec3& acceleration)
      : masses_(masses), acceleration_(acceleration), nodes_{{0, static_cast<Index>(masses.size())}}
  {}

  /** Counts these nodes alone, by ascending ranges; at first all. */
  void setNodes(const std::vector<NodeRange>& nodes) { nodes_ = nodes; }

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  double valueAndGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points&, Curvature, BlockMatrix&) override {}

 private:
  const std::vector<double>& masses_;
  Vec3 acceleration_;
  std::vector<NodeRange> nodes_;
};

/** Dead loads: -sum f . x, f constant in the world. */
class NodalLoads : public EnergyTerm
{
 public:
  /** @param forces N x 3, N */
  explicit NodalLoads(Points forces) : forces_(std::move(forces)) {}

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points&, Curvature, BlockMatrix&) override {}

 private:
  Points forces_;
};

}  // namespace soft_tissue
