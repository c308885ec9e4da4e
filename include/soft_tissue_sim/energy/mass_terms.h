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

/** 1/(2 h^2) |x - target|^2 in the lumped mass: what makes implicit Euler a minimisation. */
class Inertia : public EnergyTerm
{
 public:
  /** @param masses N, kg; must outlive the term */
  explicit Inertia(const std::vector<double>& masses) : masses_(masses) {}

  /** Target positions x + h v (N x 3, m) and h (s) of the step that begins. */
  void beginStep(const Points& x, const Points& velocities, double step);

  const Points& target() const { return target_; }

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

 private:
  const std::vector<double>& masses_;
  Points target_;
  double inverse_square_step_ = 0.0;
};

/** 1/(2 h) sum c |x - x_0|^2: a force -c v against each node's velocity. */
class Drag : public EnergyTerm
{
 public:
  /** @param coefficients N, kg/s; must outlive the term */
  explicit Drag(const std::vector<double>& coefficients) : coefficients_(coefficients) {}

  /** Positions at the start of the step that begins (N x 3, m), and h (s). */
  void beginStep(const Points& x, double step);

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points& x, Curvature curvature, BlockMatrix& hessian) override;

 private:
  const std::vector<double>& coefficients_;
  Points start_;
  double inverse_step_ = 0.0;
};

/** -sum m g . x. */
class Gravity : public EnergyTerm
{
 public:
  /** @param masses N, kg, lumped or addLoadMasses(); must outlive the term
   * @param acceleration m/s^2, world */
  Gravity(const std::vector<double>& masses, const Vec3& acceleration)
      : masses_(masses), acceleration_(acceleration)
  {}

  double value(const Points& x) override;
  void addGradient(const Points& x, Points& gradient) override;
  void addHessian(const Points&, Curvature, BlockMatrix&) override {}

 private:
  const std::vector<double>& masses_;
  Vec3 acceleration_;
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
