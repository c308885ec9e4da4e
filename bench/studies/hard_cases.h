#pragma once

#include <functional>
#include <string>
#include <vector>

#include "soft_tissue_sim/scene/scene.h"

namespace soft_tissue::studies
{
/** What physics says of the end of a hard case. */
enum class Ending
{
  returns,   ///< to the rest shape, at rest
  settles,   ///< at rest, nothing inside out; a fold at the fixed end may stay
  anything,  ///< it keeps being driven, or swings on, or sags
};

/** A scene that is hard on a solver. */
struct HardCase
{
  std::string name;
  SceneConfig config;
  Ending ending = Ending::returns;
  std::function<void(Scene&)> begin;        ///< deforms it before the first step; may be empty
  std::function<void(Scene&, int)> before;  ///< each step; may be empty
  /** Steps that hold the last good state are to be expected: it is squeezed to nothing. */
  bool may_hold = false;
};

constexpr int kHardSteps = 500;

/** How it went. */
struct HardResult
{
  std::size_t tets = 0;
  bool finite = true;        ///< all positions and velocities after each step
  double least_det_f = 0.0;  ///< after the first fifth of the steps
  double last_det_f = 0.0;
  double strain_left = 0.0;    ///< largest change of an edge's length at the end, as a share
  double rate_left = 0.0;      ///< how fast an edge's length changes at the end at most, m/s
  double energy_growth = 0.0;  ///< kinetic energy's peak in the second half over that in the first
  int held = 0;                ///< steps
  double newton = 0.0;         ///< iterations a step, mean
  double seconds = 0.0;

  bool settled() const { return last_det_f > 0.0 && rate_left < 0.01; }
  bool returned() const { return settled() && strain_left < 0.02; }
  /** Whether it ended as it should. */
  bool endedAs(Ending ending) const
  {
    return ending == Ending::anything || (ending == Ending::settles ? settled() : returned());
  }
};

/**
 * All of them, small enough to run in seconds.
 * @param folder  mesh files are left here
 * @param hard    folder of real meshes that are hard to read or to simulate, or empty
 */
std::vector<HardCase> hardCases(const std::string& folder, const std::string& hard);

/** Runs one for kHardSteps. */
HardResult runHardCase(const HardCase& hard_case);

}  // namespace soft_tissue::studies
