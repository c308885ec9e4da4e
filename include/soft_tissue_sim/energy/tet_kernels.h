#pragma once

#include <array>

#include "soft_tissue_sim/base/cpu.h"
#include "soft_tissue_sim/base/index.h"
#include "soft_tissue_sim/energy/material.h"

namespace soft_tissue
{
/** Tets are stored in groups of eight, lane by lane, whatever the instruction set: the layout is
 * part of the bits. */
constexpr Index kTetLanes = 8;

/** Constants a law needs per tet, made from its parameters once. */
constexpr int kMaterialConstants = 4;

/** Constants of what tets remember, per point, see Viscosity: twice Lame's, a strain, a stress. */
constexpr int kMemoryConstants = 14;

/** Tets of a smaller det F remember their stress as if it were this. */
constexpr double kLeastMemoryVolume = 0.1;

/** Blocks of a linear tet's stiffness. */
constexpr int kTetBlocks = 10;

/** Blocks of a quadratic tet's stiffness. */
constexpr int kQuadraticTetBlocks = 55;

/** The two of an element's nodes that a block of its stiffness couples. */
using BlockNodes = std::array<int, 2>;

/** Constant data of groups of tets; arrays hold all groups in a row. */
struct TetGroups
{
  const Index* nodes;       ///< [group][TetKernels::nodes][8], a linear tet's in any order
  const double* gradients;  ///< [group][3][3][8]: rows of the inverse rest edge matrix, 1/m
  const double* volumes;    ///< [group][8], m^3, > 0; 0 in unused lanes
  const double* constants;  ///< [group][TetKernels::constants_each][8]
  /** [group][TetKernels::parts][4][8]: barycentric coordinates of the places where the stress of
   * quadratic tets is told; linear ones have none. */
  const double* places;
};

/** Loops for a law's dilatation, which nodes take the mean of: see NodalPressureTetElasticity. */
struct DilatationKernels
{
  /** dilatations[group][8]. */
  void (*dilatation)(const TetGroups&, Index begin, Index end, const double* x,
                     double* dilatations);
  /** gradients[group][12][8], m^2: volume times the dilatation's derivative by 3 node + axis. */
  void (*gradient)(const TetGroups&, Index begin, Index end, const double* x, double* gradients);
  /** What lambda weighs of packs of eight dilatations, and its first and second derivatives. */
  void (*energy)(Index begin, Index end, const double* dilatations, double* values, double* slopes,
                 double* curvatures);
};

/** Element loops of one material and one kind of tet for one instruction set; x is flat, 3 per
 * node, m. */
struct TetKernels
{
  int nodes;                 ///< of a tet
  int parts;                 ///< of a tet that have a stress of their own
  int points;                ///< of a tet where its energy is taken
  int constants_each;        ///< of a tet: those of its law, or of what all its points remember
  int block_count;           ///< kTetBlocks or kQuadraticTetBlocks
  const BlockNodes* blocks;  ///< block_count, in the order of positions below

  /** Constants of the law, kMaterialConstants; null where there is no law. */
  void (*constants)(const LawParameters& of, double* constants);
  /** energies[group][8], J. */
  void (*energy)(const TetGroups&, Index begin, Index end, const double* x, double* energies);
  /** gradient += forces of the groups' tets, flat, 3 per node, N; and their energies. */
  void (*gradient)(const TetGroups&, Index begin, Index end, const double* x, double* gradient,
                   double* energies);
  /**
   * Adds the second derivative, N/m, to blocks of nine values by columns. Nodes must ascend within
   * each tet: only blocks on and above the diagonal are written.
   * @param positions  [group][block_count][8]: block numbers
   */
  void (*stiffness)(const TetGroups&, Index begin, Index end, const double* x,
                    const Index* positions, double* values);
  /** The same, negative eigenvalues set to zero: each linear tet's, or each Gauss point's. */
  void (*projected_stiffness)(const TetGroups&, Index begin, Index end, const double* x,
                              const Index* positions, double* values);
  /** det_f[group][8], the smallest of each tet, and, unless null, von_mises[group][parts][8] in Pa.
   * Null where there is no law. */
  void (*state)(const TetGroups&, Index begin, Index end, const double* x, double* det_f,
                double* von_mises);
  /**
   * six[group][points][6][8], symmetric matrices by xx, yy, zz, yz, xz, xy: the law's second
   * Piola-Kirchhoff stress, Pa; where there is no law, Green's strain.
   */
  void (*remember)(const TetGroups&, Index begin, Index end, const double* x, double* six);
  /** The loops for what such tets remember; null in those themselves. */
  const TetKernels* memory;
  /** Where constants end with a pressure that others give: what they have to know; else null. */
  const DilatationKernels* dilatation;
};

/** The loops for linear tets of a material on this machine. */
const TetKernels& tetKernels(MaterialModel model, InstructionSet set);

/** The same with one more constant: a pressure by which stress grows along the dilatation; energies
 * leave it out. */
const TetKernels& pressedTetKernels(MaterialModel model, InstructionSet set);

/** The loops for quadratic tets; their nodes as in QuadraticTet. */
const TetKernels& quadraticTetKernels(MaterialModel model, InstructionSet set);

}  // namespace soft_tissue
