#pragma once

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/index.h"
#include "soft_tissue_sim/energy/material.h"

namespace soft_tissue
{
/** Tets are stored in groups of eight, lane by lane, whatever the instruction set: the layout is
 * part of the bits. */
constexpr Index kTetLanes = 8;

/** Constants a law needs per tet, made from E and nu once. */
constexpr int kMaterialConstants = 4;

/** Blocks of a tet's stiffness: (0,0) (1,1) (2,2) (3,3) (0,1) (0,2) (0,3) (1,2) (1,3) (2,3). */
constexpr int kTetBlocks = 10;

/** Constant data of groups of tets; arrays hold all groups in a row. */
struct TetGroups
{
  const Index* nodes;       ///< [group][4][8], a tet's in any order
  const double* gradients;  ///< [group][3][3][8]: rows of the inverse rest edge matrix, 1/m
  const double* volumes;    ///< [group][8], m^3, > 0; 0 in unused lanes
  const double* constants;  ///< [group][kMaterialConstants][8]
};

/** Element loops of one material for one instruction set; x is flat, 3 per node, m. */
struct TetKernels
{
  /** Constants of the law from E (Pa) and nu. */
  void (*constants)(double young_modulus, double poisson_ratio, double* constants);
  /** energies[group][8], J. */
  void (*energy)(const TetGroups&, Index begin, Index end, const double* x, double* energies);
  /** gradient += forces of the groups' tets, flat, 3 per node, N; and their energies. */
  void (*gradient)(const TetGroups&, Index begin, Index end, const double* x, double* gradient,
                   double* energies);
  /**
   * Adds the second derivative, N/m, to blocks of nine values by columns. Nodes must ascend within
   * each tet: only blocks on and above the diagonal are written.
   * @param positions  [group][kTetBlocks][8]: block numbers
   */
  void (*stiffness)(const TetGroups&, Index begin, Index end, const double* x,
                    const Index* positions, double* values);
  /** The same, each tet's negative eigenvalues set to zero. */
  void (*projected_stiffness)(const TetGroups&, Index begin, Index end, const double* x,
                              const Index* positions, double* values);
  /** det_f[group][8] and, unless null, von_mises[group][8] in Pa. */
  void (*state)(const TetGroups&, Index begin, Index end, const double* x, double* det_f,
                double* von_mises);
};

/** The loops for a material on this machine. */
const TetKernels& tetKernels(MaterialModel model, InstructionSet set);

}  // namespace soft_tissue
