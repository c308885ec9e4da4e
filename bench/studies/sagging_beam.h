#pragma once

#include <memory>
#include <string>
#include <vector>

#include "soft_tissue_sim/energy/mass_terms.h"
#include "soft_tissue_sim/energy/tet_elasticity.h"
#include "soft_tissue_sim/scene/config.h"

namespace soft_tissue::studies
{
/** A beam of 100 x 20 x 20 mm, E 5 kPa, nu 0.45, 1000 kg/m^3, clamped at x = 0, which sags along -y
 * from straight, in steps of 10 ms. */
struct BeamSetup
{
  std::string mesh;  ///< file
  ElementKind element = ElementKind::tet4;
  MaterialModel law = MaterialModel::corotated;
  double gravity_m_per_s2 = 9.81;
  SolverConfig solver = {};
};

/**
 * A mesh of about so many thousand tets: for 1, 5 and 20 beams/beam1k.msh and so on below
 * $SOFT_TISSUE_DATA; else, and without it, a box of cells.
 * @param folder     where a box is written
 * @param thousands  0: a box of 240 tets
 * @return the file
 * @throws Error if a box can't be written
 */
std::string beamMesh(const std::string& folder, int thousands);

SceneConfig beamScene(const BeamSetup& setup);

/** The four corners at the far end. @throws Error unless there are four */
std::vector<Index> beamTip(const Points& rest);

/** Mean way of these nodes, m. */
Vec3 meanWay(const std::vector<Index>& nodes, const Points& rest, const Points& x);

/** Nodes at x = 0, ascending. */
std::vector<Index> clampedNodes(const Points& rest);

/**
 * How far a step of backward Euler is from balance, by one measure for whoever took it:
 * NewtonOptions::tolerance's, with inertia, gravity and the corotated law of linear tets.
 */
class StepResidual
{
 public:
  /** @param rest  must outlive it */
  StepResidual(const TetMesh& rest, const BeamSetup& setup);

  /**
   * @param x, v   N x 3 before the step, m and m/s
   * @param after  N x 3, m
   */
  double of(const Points& x, const Points& v, double step_s, const Points& after);

 private:
  std::vector<double> masses_;
  std::vector<Index> fixed_;
  TetElasticity elasticity_;
  Gravity gravity_;
  Inertia inertia_;
  Points sum_, term_;
};

}  // namespace soft_tissue::studies
