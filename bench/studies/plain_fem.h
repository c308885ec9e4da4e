#pragma once

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "soft_tissue_sim/energy/material.h"
#include "soft_tissue_sim/mesh/tet_mesh.h"

namespace soft_tissue::studies
{
/**
 * What a good engineer writes in a day, to compare with: corotated linear tets, backward Euler, the
 * tangent with rotations held, assembled into a sparse matrix of scalars at places looked up once,
 * Eigen's conjugate gradients with its diagonal preconditioner. One thread.
 */
class PlainFem
{
 public:
  struct Options
  {
    Vec3 gravity = Vec3::Zero();  ///< m/s^2
    double step_s = 0.01;
    double linear_tolerance = 1e-3;  ///< residual over the right side's norm
    int linearisations = 1;          ///< at most, in a step
    /** Those after the first only while forces, by NewtonOptions::tolerance, are off by more. */
    double tolerance = 1e-3;
  };

  /**
   * @param rest   must outlive it
   * @param fixed  nodes that stay where they are
   */
  PlainFem(const TetMesh& rest, const std::vector<Index>& fixed, const TetStiffnessParameters& law,
           double density_kg_per_m3, const Options& options);

  void step();

  const Points& positions() const { return x_; }               ///< N x 3, m
  const Points& velocities() const { return v_; }              ///< N x 3, m/s
  int linearisations() const { return linearisations_; }       ///< of the last step
  int linearIterations() const { return linear_iterations_; }  ///< of the last step

 private:
  struct Element
  {
    double volume = 0.0;            ///< m^3
    std::array<Vec3, 4> gradients;  ///< of the shape functions at rest, 1/m
    std::array<std::array<std::array<Index, 3>, 4>, 4> places;  ///< of each block's rows, or -1
  };
  void makePattern();
  double assemble();
  void addElement(std::size_t number);

  const TetMesh& rest_;
  Options options_;
  Lame lame_;
  std::vector<Index> unknown_;  ///< per node: its row of blocks, or -1
  std::vector<double> masses_;  ///< kg
  std::vector<Element> elements_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_;
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double, Eigen::RowMajor>,
                           Eigen::Lower | Eigen::Upper>
      solver_;
  Eigen::VectorXd force_, elastic_, move_;
  Points x_, v_, target_;
  int linearisations_ = 0, linear_iterations_ = 0;
};

}  // namespace soft_tissue::studies
