#pragma once

#include <string>

#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue::studies
{
/** A rigid shape pressed into a half space of one material, with what contact mechanics says of it
 * where depths are small. */
struct Indentation
{
  enum class Shape
  {
    sphere,  ///< Source: [Hertz1882]
    punch,   ///< flat and round. Source: [Sneddon1965]
    cone,    ///< Source: [Sneddon1965]
  };
  Shape shape = Shape::sphere;
  double radius_m = 0.005;                 ///< of sphere or punch
  double half_angle = 1.0471975511965976;  ///< of the cone, rad
  double depth_m = 0.001;
  double young_modulus_pa = 5000.0;
  double poisson_ratio = 0.45;
  /** Half the width of the block in place of the half space, and its depth, in contact radii. */
  double block = 27.0;

  double force() const;          ///< N
  double contactRadius() const;  ///< m
  /** Of the force, what acts within this share of the contact radius. */
  double shareWithin(double share) const;
};

/** How it is computed. */
struct IndentationMesh
{
  /** Above 0: the block is round, in rings of cells about the radius of contact, of so many nodes
   * each (blockAroundEdge). Otherwise it is a box, finest at the tip (blockAroundTip). */
  int around = 0;
  int cells = 12;       ///< of the box, from the axis to each side; twice as many across
  double growth = 4.5;  ///< of its cells outwards
  ElementKind element = ElementKind::tet4;
  Response response = Response::segment;
  double stiffness = 400.0;  ///< kappa, in Young's moduli over the radius of contact
};

/** What came out. */
struct IndentationResult
{
  std::size_t tets = 0, nodes = 0;  ///< quadratic tets count as those they are cut into
  double element_m = 0.0;           ///< edge of a cell, under the tip or at the edge
  double force = 0.0;               ///< N, along the axis
  double across = 0.0;              ///< N, besides
  double radius_m = 0.0;            ///< of what touches
  double force_within_half = 0.0;   ///< N, within half of the contact radius expected
  double penetration_m = 0.0;
  int newton_iterations = 0;
  bool converged = true;
  double seconds = 0.0;
};

/**
 * Presses in five quasi-static steps into a block whose cells grow from the tip outwards; its lower
 * side is fixed.
 * @param folder  mesh files of block and tool are left here
 */
IndentationResult indent(const Indentation& problem, const IndentationMesh& mesh,
                         const std::string& folder);

}  // namespace soft_tissue::studies
